//! Any formula and any text: nothing panics, what is printed is read again, and the tape says what the tree says.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

use mrbd_formula::{CarriedState, Expression, Formula, Function, Operator, Parameter, Place, Range};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const RANGE: Range = Range { low: [-0.5, -10.0, 0.0], high: [0.5, 10.0, 0.0] };

/// Expressions without a unit, of variables over parameters.
fn expressions() -> impl Strategy<Value = Expression> {
    let number = prop_oneof![
        (0_u32..50).prop_map(|n| Expression::Number(f64::from(n) / 4.0)),
        (-8.0..8.0_f64).prop_map(|e| Expression::Number(10_f64.powf(e))),
    ];
    let over = |variable: &str, size: &str| {
        Expression::binary(Operator::Divide, Expression::name(variable), Expression::name(size))
    };
    let leaf = prop_oneof![number, Just(over("x", "g")), Just(over("v", "s")), Just(Expression::name("p"))];
    leaf.prop_recursive(6, 48, 2, |inner| {
        use Operator::{Add, Divide, Greater, GreaterOrEqual, Less, LessOrEqual, Multiply, Power, Subtract};
        let operators = [Add, Subtract, Multiply, Divide, Power, Less, LessOrEqual, Greater, GreaterOrEqual];
        let one =
            [Function::Abs, Function::Sign, Function::Sqrt, Function::Exp, Function::Tanh, Function::Atan];
        let two = [Function::Max, Function::Min];
        let of_two = move |(f, a, b): (usize, Expression, Expression)| {
            Expression::OfTwo(two[f], Box::new(a), Box::new(b))
        };
        prop_oneof![
            (0..operators.len(), inner.clone(), inner.clone()).prop_map(move |(o, a, b)| Expression::binary(
                operators[o],
                a,
                b
            )),
            (0..one.len(), inner.clone()).prop_map(move |(f, a)| Expression::Of(one[f], Box::new(a))),
            (0..two.len(), inner.clone(), inner.clone()).prop_map(of_two),
            inner.prop_map(|a| Expression::Negative(Box::new(a))),
        ]
    })
}

/// A force made of it.
fn formula(expression: Expression) -> Option<Formula> {
    let force = Expression::binary(Operator::Multiply, Expression::name("F"), expression);
    let all = [("F", 2.0, "N"), ("g", 0.03, "m"), ("s", 0.4, "m/s"), ("p", 1.7, "1")];
    let used = all.into_iter().filter(|(name, ..)| force.has(name));
    let used: Vec<_> = used.map(|(name, value, unit)| Parameter::new(name, value, unit)).collect();
    Formula::parse(&force.to_string(), Place::Top, &used).ok()
}

/// A force of a state that changes by an expression of it, x and v.
fn carrying(expression: Expression) -> Option<Formula> {
    let rate = Expression::binary(Operator::Multiply, Expression::name("r"), with_state(expression));
    let all = [("F", 2.0, "N"), ("r", 3.0, "m/s"), ("g", 0.03, "m"), ("s", 0.4, "m/s"), ("p", 1.7, "1")];
    let used = all.into_iter().filter(|(name, ..)| *name == "F" || *name == "g" || rate.has(name));
    let used: Vec<_> = used.map(|(name, value, unit)| Parameter::new(name, value, unit)).collect();
    let state = CarriedState {
        name: "z".to_owned(),
        rate: rate.to_string(),
        start: 0.0,
        unit: "m".to_owned(),
        range: None,
    };
    Formula::parse_with_states("-F*z/g", Place::Top, &used, &[state]).ok()
}

/// The parameter p, a pure number, becomes z/g.
fn with_state(e: Expression) -> Expression {
    let of = |part: Box<Expression>| Box::new(with_state(*part));
    match e {
        Expression::Name(name) if name == "p" => {
            Expression::binary(Operator::Divide, Expression::name("z"), Expression::name("g"))
        }
        Expression::Negative(a) => Expression::Negative(of(a)),
        Expression::Binary(operator, a, b) => Expression::Binary(operator, of(a), of(b)),
        Expression::Of(function, a) => Expression::Of(function, of(a)),
        Expression::OfTwo(function, a, b) => Expression::OfTwo(function, of(a), of(b)),
        other => other,
    }
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(20), ..ProptestConfig::default() })]

    #[test]
    fn analytic_what_is_printed_is_read_as_the_same(e in expressions()) {
        if let Some(law) = formula(e.clone()) {
            let force = Expression::binary(Operator::Multiply, Expression::name("F"), e);
            prop_assert_eq!(law.expression(), &force);
        }
    }

    #[test]
    fn analytic_the_tape_says_what_the_tree_says(e in expressions(), x in -0.5..0.5_f64, v in -10.0..10.0_f64) {
        let Some(law) = formula(e) else { return Ok(()) };
        for state in [[x, v, 0.0], [0.0; 3], [x, 0.0, 0.0], [0.0, v, 0.0]] {
            let (tape, tree) = (law.value(state), law.value_as_written(state));
            // The sign of a product that is no number is still the product of signs.
            prop_assert!(same(tape, tree) || tree.is_nan(), "{} at {:?}: {} and {}", law, state, tape, tree);
        }
    }

    #[test]
    fn analytic_the_branch_of_a_state_gives_its_value(e in expressions(), x in -0.5..0.5_f64, v in -10.0..10.0_f64) {
        let Some(law) = formula(e) else { return Ok(()) };
        // Where the formula is a number: elsewhere a frozen root is zero.
        if law.check(&RANGE).is_err() {
            return Ok(());
        }
        let (state, value) = (mrbd_formula::state([x, v, 0.0]), law.value([x, v, 0.0]));
        let branches = law.program().branches_at(state, mrbd_formula::state([0.0; 3]));
        if law.program().switches().iter().any(|switch| switch.argument(state, &branches) == 0.0) {
            return Ok(());
        }
        prop_assert!(same(law.program().value(state, &branches), value), "{}", law);
    }

    #[test]
    fn analytic_what_is_shown_finite_is_finite(e in expressions(), shares in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64), 8)) {
        let Some(law) = formula(e) else { return Ok(()) };
        if law.check(&RANGE).is_ok() {
            for (a, b) in shares {
                let state = [-0.5 + a, -10.0 + 20.0 * b, 0.0];
                prop_assert!(law.value(state).abs() <= 1e15, "{} at {:?}: {}", law, state, law.value(state));
            }
        }
    }

    #[test]
    fn analytic_the_rate_is_the_slope(e in expressions(), x in -0.5..0.5_f64, v in -10.0..10.0_f64) {
        let Some(law) = formula(e) else { return Ok(()) };
        let [state, rates] = [[x, v, 0.0], [1.0, 3.0, 0.0]].map(mrbd_formula::state);
        let branches = law.program().branches_at(state, mrbd_formula::state([0.0; 3]));
        let at = |h: f64| law.program().value(mrbd_formula::state([x + h, v + 3.0 * h, 0.0]), &branches);
        let (h, rate) = (1e-6, law.program().rate(state, rates, &branches));
        let slopes = [(at(h) - at(-h)) / (2.0 * h), (at(0.5 * h) - at(-0.5 * h)) / h];
        // Where the difference has converged: elsewhere the formula turns within a millionth.
        let size = slopes[0].abs() + 1e-3 * at(0.0).abs() + 1e-6;
        if slopes.iter().all(|s| s.is_finite()) && (slopes[0] - slopes[1]).abs() < 1e-4 * size {
            prop_assert!((rate - slopes[1]).abs() < 1e-2 * size, "{}: {} and {:?}", law, rate, slopes);
        }
    }

    #[test]
    fn analytic_a_state_that_is_shown_bounded_never_leaves(e in expressions(), decay in 0.0..3.0_f64, moves in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64), 40)) {
        // Most rates bound nothing: one that draws back, too.
        let back = Expression::binary(Operator::Multiply, Expression::Number(decay.exp()), Expression::name("p"));
        for rate in [e.clone(), Expression::binary(Operator::Subtract, e, back)] {
            let Some(law) = carrying(rate) else { continue };
            let again = Formula::parse_with_states(&law.to_string(), Place::Top, law.parameters(), law.states());
            prop_assert_eq!(again.as_ref(), Ok(&law));
            let (Ok(_), Ok(ranges)) = (law.check(&RANGE), law.state_ranges(&RANGE)) else { continue };
            let [least, most] = ranges[0];
            for (a, b) in &moves {
                for end in [least, most] {
                    let state = [-0.5 + a, -10.0 + 20.0 * b, 0.0, end, 0.0];
                    let [rate, _] = law.program().state_rates(state, &mrbd_formula::Branches::FREE);
                    prop_assert!(rate.is_finite() && rate * end.signum() <= 0.0, "{} at {:?}: {}", law.states()[0].rate, state, rate);
                }
                let inside = [-0.5 + b, -10.0 + 20.0 * a, 0.0, least + (most - least) * b, 0.0];
                let [rate, _] = law.program().state_rates(inside, &mrbd_formula::Branches::FREE);
                prop_assert!(rate.is_finite() && law.value_with_states(inside).is_finite(), "{} at {:?}", law.states()[0].rate, inside);
            }
        }
    }

    #[test]
    fn rejects_or_reads_any_text(bytes in prop::collection::vec(any::<u8>(), 0..120)) {
        let text = String::from_utf8_lossy(&bytes);
        let _ = Formula::parse(&text, Place::Top, &[Parameter::new("k", 1.0, &text)]);
        let state = CarriedState { name: "z".to_owned(), rate: text.to_string(), start: 0.0, unit: text.to_string(), range: None };
        let _ = Formula::parse_with_states(&text, Place::Top, &[], &[state]);
    }

    #[test]
    fn rejects_or_reads_any_words(words in prop::collection::vec(0..24_usize, 0..80)) {
        const WORDS: [&str; 24] = [
            "x", "v", "k", "0", "1.5", "1e3", "+", "-", "*", "/", "**", "(", ")", ",", "abs(", "sign(", "max(",
            "min(", "sqrt(", "exp(", "<", ">=", " ", "phi",
        ];
        let text: String = words.into_iter().map(|word| WORDS[word]).collect();
        if let Ok(law) = Formula::parse(&text, Place::Top, &[Parameter::new("k", 1.0, "N/m")]) {
            let again = Formula::parse(&law.to_string(), Place::Top, law.parameters()).expect("read again");
            prop_assert_eq!(again.expression(), law.expression());
            let _ = law.check(&RANGE);
        }
    }
}

/// Python reads formulas so.
const READER: &str = "
import sys
from math import sqrt, exp, tanh, atan
sign = lambda a: (a > 0) - (a < 0)
names = dict(abs=abs, sign=sign, max=max, min=min, sqrt=sqrt, exp=exp, tanh=tanh, atan=atan)
for line in sys.stdin:
    x, v, text = line.rstrip().split(';')
    try:
        value = eval(text, dict(names, x=float(x), v=float(v), F=2.0, g=0.03, s=0.4, p=1.7))
        print(float(value) if not isinstance(value, complex) else 'none')
    except (ZeroDivisionError, OverflowError, ValueError, TypeError):
        print('none')
";

#[test]
fn verified_python_reads_a_formula_the_same_way() {
    let python =
        Command::new("python3").args(["-c", READER]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let Ok(mut python) = python else {
        eprintln!("skipped: there is no python3 to read formulas with");
        return;
    };
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let strategy = (expressions(), -0.5..0.5_f64, -10.0..10.0_f64);
    let mut cases = Vec::new();
    let mut lines = String::new();
    while cases.len() < 1000 {
        let tree = strategy.new_tree(&mut runner).expect("an expression");
        let (e, x, v) = proptest::strategy::ValueTree::current(&tree);
        if let Some(law) = formula(e) {
            writeln!(lines, "{x};{v};{law}").expect("to a text");
            cases.push((law.to_string(), law.value([x, v, 0.0])));
        }
    }
    let mut input = python.stdin.take().expect("a pipe");
    std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let output = python.wait_with_output().expect("python ends");
    let answers = String::from_utf8(output.stdout).expect("text");
    assert_eq!(answers.lines().count(), cases.len());
    let mut compared = 0;
    for ((text, value), answer) in cases.iter().zip(answers.lines()) {
        match answer.parse::<f64>() {
            Ok(answer) if answer.is_finite() => {
                // Both round powers and exponentials in their own way, and a power magnifies it.
                let near = (answer - value).abs() <= 1e-10 * answer.abs() + 1e-300;
                assert!(near, "{text}: {value} and {answer}");
                compared += 1;
            }
            _ => assert!(!value.is_finite(), "{text}: {value} and {answer}"),
        }
    }
    assert!(compared > 300, "{compared} formulas with a value");
}
