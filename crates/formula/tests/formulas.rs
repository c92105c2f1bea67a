//! Formulas: what they give, what they say of themselves, and what is refused.

use mrbd_formula::{Branch, Branches, Formula, Jump, Parameter, Place, Range};

fn parameters() -> Vec<Parameter> {
    [
        ("k", 37e3, "N/m"),
        ("k3", 4e6, "N/m**3"),
        ("c", 1500.0, "N*s/m"),
        ("d", 900.0, "N*(s/m)**p"),
        ("p", 1.7, "1"),
        ("F", 300.0, "N"),
        ("g", 0.01, "m"),
        ("s", 0.2, "m/s"),
        ("e", 0.1, ""),
    ]
    .map(|(name, value, unit)| Parameter::new(name, value, unit))
    .to_vec()
}

/// A formula with those of the parameters above that it uses.
fn top(text: &str) -> Result<Formula, mrbd_formula::FormulaError> {
    let is_of_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<_> = text.split(|c| !is_of_name(c)).collect();
    let mut used: Vec<_> = parameters().into_iter().filter(|p| words.contains(&p.name.as_str())).collect();
    if words.contains(&"d") && !words.contains(&"p") {
        used.retain(|p| p.name != "d");
        used.push(Parameter::new("d", 900.0, "N*(s/m)**1.7"));
    }
    Formula::parse(text, Place::Top, &used)
}

fn good(text: &str) -> Formula {
    top(text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

const RANGE: Range = Range { low: [-0.5, -10.0, 0.0], high: [0.5, 10.0, 0.0] };

#[test]
fn analytic_a_formula_gives_what_it_says() {
    for (text, state, value) in [
        ("-k*x", [0.01, 0.0, 0.0], -370.0),
        ("-k3*x**3", [0.1, 0.0, 0.0], -4e6 * (0.1 * 0.1 * 0.1)),
        ("-k*x - c*v", [0.01, -0.1, 0.0], -370.0 + 150.0),
        ("-F*sign(v)", [0.0, -2.0, 0.0], 300.0),
        ("-F*sign(v)", [0.0, 0.0, 0.0], 0.0),
        ("-k*max(0, abs(x) - g)*sign(x)", [-0.03, 0.0, 0.0], 37e3 * (0.03 - 0.01)),
        ("-k*(x > g)*(x - g)", [0.005, 0.0, 0.0], 0.0),
        ("-k*min(x, g, -g)", [1.0, 0.0, 0.0], 370.0),
        ("-F*tanh(v/s)*2**3**0", [0.0, 0.2, 0.0], -300.0 * libm::tanh(1.0) * 2.0),
        ("--F*1.5", [0.0; 3], 450.0),
        ("-F*-e**2", [0.0; 3], 300.0 * 0.1 * 0.1),
        ("F*(x/g)**-1", [0.02, 0.0, 0.0], 150.0),
        ("F*(1 - exp(-abs(x)/g)) + F*atan(v/s)*0", [0.01, 1.0, 0.0], 300.0 * (1.0 - libm::exp(-1.0))),
    ] {
        let found = good(text).value(state);
        // A few roundings of a product.
        assert!((found - value).abs() <= 1e-13 * value.abs(), "{text}: {found} for {value}");
    }
}

#[test]
fn analytic_signs_and_powers_bind_as_in_python() {
    // Precedence as in Python: a sign binds less than a power and more than a product.
    assert_eq!(good("-F*2**2").to_string(), "-F*2**2");
    assert_eq!(good("F*(-2)**2").value([0.0; 3]), 1200.0);
    assert_eq!(good("-F*2**2").value([0.0; 3]), -1200.0);
    assert_eq!(good("F*2**-1").value([0.0; 3]), 150.0);
    assert_eq!(good("F*2**2**3").value([0.0; 3]), 300.0 * 256.0);
    assert_eq!(good("F/2/3*6").value([0.0; 3]), 300.0);
}

#[test]
fn analytic_a_unit_may_follow_a_parameter() {
    let law = good("-d*abs(v)**p*sign(v)");
    let values: Vec<_> =
        law.parameters().iter().map(|p| if p.name == "p" { 1.55 } else { p.value }).collect();
    let moved = law.with_values(&values).expect("the unit follows p");
    assert!((moved.value([0.0, 2.0, 0.0]) + 900.0 * 2f64.powf(1.55)).abs() < 1e-9);
    // A unit written with the number does not.
    let fixed = [Parameter::new("d", 900.0, "N*(s/m)**1.7"), Parameter::new("p", 1.7, "1")];
    let law = Formula::parse("-d*abs(v)**p*sign(v)", Place::Top, &fixed).expect("1.7 is 1.7");
    assert!(law.with_values(&[900.0, 1.55]).is_err());
}

#[test]
fn analytic_a_moment_at_a_joint_may_use_rotation_rate_and_weight() {
    let own =
        [Parameter::new("mu", 0.3, "m"), Parameter::new("s", 0.1, "1/s"), Parameter::new("k", 2e5, "N*m")];
    let law = Formula::parse("-k*phi - mu*N*tanh(w/s)", Place::Crack, &own).expect("a moment");
    let value = law.value([0.01, 0.1, 1000.0]);
    assert!((value - (-2000.0 - 300.0 * libm::tanh(1.0))).abs() < 1e-9, "{value}");
}

#[test]
fn analytic_switches_are_where_branches_change() {
    // One switch serves abs and sign of the same, and a comparison of it.
    for (text, count) in [
        ("-k*x", 0),
        ("-d*abs(v)**1.7*sign(v)", 1),
        ("-F*sign(v)*(v > 0)", 1),
        ("-k*x*(1 + e*sign(x*v))", 2),
        ("-k*max(0, x - g) - k*(x > g)*0*x", 1),
        ("-k*max(0, abs(x) - g)*sign(x)", 2),
        ("-F*max(-1, min(1, v/s))", 2),
    ] {
        assert_eq!(good(text).program().switches().len(), count, "{text}");
    }
}

#[test]
fn analytic_jumps_are_told_apart() {
    for (text, jump) in [
        ("-F*sign(v)", Jump::AgainstMotion),
        ("-k*x - F*(1 + e*exp(-abs(v)/s))*sign(v)", Jump::AgainstMotion),
        ("-F*abs(x)/g*sign(v)", Jump::AgainstMotion),
        ("-d*abs(v)**1.7*sign(v)", Jump::None),
        ("-c*v*(v > 0)", Jump::None),
        ("-c*v*(x > g)", Jump::AtDisplacement),
        ("-F*(x > g)", Jump::AtDisplacement),
        ("-c*v*(x > 0)", Jump::AtDisplacement),
        ("-k*x*(x_max < g)", Jump::AtDisplacement),
        ("-k*(x - g)*(abs(x) > g)", Jump::None),
    ] {
        let law = good(text);
        let jumps = law.check(&RANGE).unwrap_or_else(|e| panic!("{text}: {e}"));
        let last = jumps.last().copied().unwrap_or(Jump::None);
        let expected = if text.contains("abs(x) > g") { Jump::AtDisplacement } else { jump };
        assert_eq!(last, expected, "{text}");
    }
}

#[test]
fn analytic_a_frozen_branch_goes_on_beyond_its_end() {
    let law = good("-k*max(0, x - g)");
    let closed = Branches::FREE.with(0, Branch::Positive);
    let open = Branches::FREE.with(0, Branch::Negative);
    let value =
        |x: f64, branches: &Branches| law.program().value(mrbd_formula::state([x, 0.0, 0.0]), branches);
    assert_eq!(value(0.0, &closed), 370.0);
    assert_eq!(value(0.02, &open), 0.0);
    // No root is beyond the end of a branch.
    let law = good("-d*abs(v)**1.7*sign(v)");
    let forward = Branches::FREE.with(0, Branch::Positive);
    assert_eq!(law.program().value(mrbd_formula::state([0.0, -0.1, 0.0]), &forward), 0.0);
}

#[test]
fn rejects_what_is_no_formula() {
    for (text, parts) in [
        ("", &["character 1", "the end"][..]),
        ("-k*", &["character 4", "the end", "a number, a name"]),
        ("-k*x)", &["character 5", "`)`"]),
        ("-k*(x", &["character 6", "`)`"]),
        ("k x", &["character 3", "`x`", "an operator"]),
        ("2x", &["character 1", "`2x`", "`*`"]),
        ("-k*x^3", &["character 5", "`^`", "`**`"]),
        ("-k*x == 3", &["`=`", "comparisons"]),
        ("0 < x < g", &["character 7", "second comparison"]),
        ("sin(x/g)*F", &["character 1", "`sin`", "abs, sign"]),
        ("abs*F", &["character 4", "`(` after `abs`"]),
        ("max(F)", &["1 numbers for `max`", "two or more"]),
        ("abs(F, F)", &["2 numbers for `abs`", "one"]),
        ("F*1e999", &["`1e999`", "finite"]),
        ("-q*x", &["character 2", "unknown name `q`", "x, v, x_max"]),
        ("-F*a", &["character 4", "unknown name `a`", "carriage_mass"]),
        ("import os", &["character 8", "`os`"]),
        ("__import__(os)", &["a function `__import__`"]),
        ("x", &["`x` in m", "N"]),
        ("-k*x - c*x", &["`c*x`", "N*s", "one unit"]),
        ("-k*(x - 0.01)", &["character 5", "`0.01` in a pure number", "a parameter"]),
        ("-F*tanh(v)", &["`v` in m/s for `tanh`", "divide"]),
        ("-F*e**x", &["exponent `x` in m"]),
        ("-F*(v/s)**(x/g) - k*g*(x**(v/s))", &["`x` in m to the power `v/s`, which varies"]),
        ("-c*abs(v)**1.7*sign(v)", &["in N*m**0.7/s**0.7; allowed: N"]),
    ] {
        let message = top(text).expect_err(text).to_string();
        for part in parts {
            assert!(message.contains(part), "{text}: {message} without {part}");
        }
    }
    let deep = format!("{}x{}", "(".repeat(200), ")".repeat(200));
    assert!(top(&deep).expect_err("deep").to_string().contains("nested too deeply"));
    assert!(top(&"-".repeat(200)).expect_err("deep").to_string().contains("nested too deeply"));
    assert!(top(&"F+".repeat(600)).expect_err("long").to_string().contains("1200 characters"));
    assert!(top(&format!("F{}", "+F".repeat(200))).is_err());
}

#[test]
fn rejects_parameters_that_are_none() {
    let parse = |name: &str, value: f64, unit: &str| {
        Formula::parse(&format!("-{name}*x"), Place::Top, &[Parameter::new(name, value, unit)])
    };
    for (name, value, unit, part) in [
        ("k", 1.0, "kN/m", "`kN` in `kN/m`"),
        ("k", 1.0, "N/", "`N/`"),
        ("k", 1.0, "lb", "`lb`"),
        ("k", f64::NAN, "N/m", "NaN"),
        ("lambda", 1.0, "N/m", "no word of Python"),
        ("exp", 1.0, "N/m", "`(` after `exp`"),
        ("sign_", f64::INFINITY, "N/m", "inf"),
        ("v", 1.0, "N/m", "no variable"),
        ("2k", 1.0, "N/m", "2k"),
    ] {
        let error = parse(name, value, unit).expect_err(name).to_string();
        assert!(error.contains(part), "{name} {unit}: {error}");
    }
    let more = [Parameter::new("k", 1.0, "N/m"), Parameter::new("q", 1.0, "m")];
    let error = Formula::parse("-k*x", Place::Top, &more).expect_err("q").to_string();
    assert!(error.contains("`q`, which the formula does not use"), "{error}");
}

#[test]
fn rejects_what_is_not_finite_or_jumps_where_no_motion_goes_on() {
    for (text, parts) in [
        ("F*g/(x - g)", &["`F*g/(x - g)`", "`x - g` may be zero", "x from -0.5 to 0.5"][..]),
        ("F*x/abs(x)", &["may be zero"]),
        ("F*(v/s)**1.5", &["`v/s` may be negative", "abs(v/s)**1.5*sign(v/s)"]),
        ("F*sqrt(x/g)", &["may be negative"]),
        ("F*(x/g)**-2", &["may be zero"]),
        ("F*exp(exp(abs(v)/s))", &["too large"]),
        ("-F*exp(abs(v)/s)", &["beyond 1e15"]),
        ("F*sign(v)", &["v = 0", "not everywhere against the motion", "-F*sign(v)"]),
        ("-k*x*sign(v)", &["not everywhere against the motion"]),
        ("-F*sign(x)", &["x = 0", "where the wall rests", "tanh(x/s)"]),
        ("-F*(v > s)", &["v = 0.2", "max(0, v - 0.2)"]),
        ("-F*sign(v/s + x/g)", &["`sign` or a comparison", "v"]),
    ] {
        let message = good(text).check(&RANGE).expect_err(text).to_string();
        for part in parts {
            assert!(message.contains(part), "{text}: {message} without {part}");
        }
    }
    // What looks like a pole and is none is shown by halves.
    for text in ["F*x/(g + abs(x))", "F/(x**2/g**2 - x/g + 1)", "F*sqrt(max(0, x/g))", "-F*exp(-abs(v)/s)"] {
        good(text).check(&RANGE).unwrap_or_else(|e| panic!("{text}: {e}"));
    }
}
