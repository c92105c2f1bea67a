//! Laws of force and moment that no catalogue has: what they are worth, and how wall files write them.
//!
//! Forces are worked out here once more, for the second simulator and the scorer: no code of the library enters.

use serde_json::{Map, Value, json};

/// Where a law acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    Top,
    Ground,
    Crack,
}

/// How a law follows displacement q and velocity u, both as shares of their reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    /// sgn(q) |q|^n.
    Spring { n: f64 },
    /// max(±q − g, 0)^n on one side.
    Stop { side: f64, g: f64, n: f64 },
    /// sgn(q) max(|q| − g, 0)^n.
    DeadZone { g: f64, n: f64 },
    /// tanh(q/d).
    Saturation { d: f64 },
    /// sgn(u) |u|^n.
    Drag { n: f64 },
    /// |q|^p sgn(u) |u|^n.
    Opening { p: f64, n: f64 },
    /// tanh(u/s).
    DragSaturation { s: f64 },
    /// max(±u, 0)^n in one direction.
    OneWay { side: f64, n: f64 },
    /// (q/d)/(1 + (q/d)²): gives way beyond d.
    Snapping { d: f64 },
    /// sgn(q) (exp(|q|/d) − 1).
    Hardening { d: f64 },
    /// u exp(−(q/d)²): damping near rest alone.
    NearRest { d: f64 },
    /// (u/s)/(1 + (u/s)²): drag that fades with velocity.
    Slipping { s: f64 },
    /// A wave of straight lines, as over teeth: up to d, through nothing at 2 d, up again from 3 d to 5 d, and down for good.
    Teeth { d: f64 },
    /// −q m/(g + m) with the largest |q| so far, m: the floor's spring, softer for good.
    Weakening { g: f64 },
    /// q/(g + m): saturates, and goes back straight.
    Secant { g: f64 },
    /// sgn(q) max(|q| − a m, 0): slack that grows.
    Slack { a: f64 },
    /// z of ż = u − z/τ, times in shares of that in which the reach is passed at its velocity: a spring behind a damper.
    Relaxing { tau: f64 },
    /// z of ż = (u/d)(1 − |z|ⁿ (1 + sgn(u z))/2): a spring that yields smoothly.
    Yielding { d: f64, n: f64 },
}

/// A law of one form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    pub site: Site,
    pub form: Form,
    /// What one is, N or N m.
    pub size: f64,
    /// Displacement and velocity of which q and u are shares: m and m/s, or rad and rad/s.
    pub reach: [f64; 2],
}

impl Site {
    /// Its name in wall files.
    pub fn name(self) -> &'static str {
        match self {
            Site::Top => "top",
            Site::Ground => "ground",
            Site::Crack => "crack",
        }
    }

    /// The key of a formula in wall files.
    pub fn key(self) -> &'static str {
        if self == Site::Top { "force_n" } else { "moment_n_m" }
    }

    /// Displacement and velocity by their names in formulas.
    fn variables(self) -> [&'static str; 2] {
        if self == Site::Top { ["x", "v"] } else { ["phi", "w"] }
    }

    /// Units of the law, of displacement and of velocity.
    fn units(self) -> [&'static str; 3] {
        if self == Site::Top { ["N", "m", "m/s"] } else { ["N*m", "rad", "rad/s"] }
    }
}

fn odd(x: f64, n: f64) -> f64 {
    x.signum() * x.abs().powf(n)
}

impl Atom {
    /// Whether it carries a state along: z, which stands for the largest displacement so far, in shares of the reach.
    pub fn carries(&self) -> bool {
        matches!(self.form, Form::Relaxing { .. } | Form::Yielding { .. })
    }

    /// The share of z that is left after a time without motion.
    pub fn left_after(&self, time_s: f64) -> f64 {
        match self.form {
            Form::Relaxing { tau } => (-time_s * self.reach[1] / self.reach[0] / tau).exp(),
            _ => 1.0,
        }
    }

    /// z after a displacement by dx in a time, from one of z.
    pub fn carried(&self, z: f64, dx_m: f64, time_s: f64) -> f64 {
        let dq = dx_m / self.reach[0];
        match self.form {
            Form::Relaxing { tau } => {
                // Steady velocity over the time.
                let steps = time_s * self.reach[1] / self.reach[0] / tau;
                let mean = if steps > 1e-9 { (1.0 - (-steps).exp()) / steps } else { 1.0 };
                z * (-steps).exp() + dq * mean
            }
            Form::Yielding { d, n } => {
                let parts = (dq.abs() / (0.02 * d)).ceil().max(1.0);
                let h = dq / d / parts;
                let rate =
                    |z: f64| 1.0 - z.abs().powf(n) * 0.5 * (1.0 + (h * z).signum() * f64::from(z != 0.0));
                let mut z = z;
                for _ in 0..parts as usize {
                    let k1 = rate(z);
                    let k2 = rate(z + 0.5 * h * k1);
                    let k3 = rate(z + 0.5 * h * k2);
                    let k4 = rate(z + h * k3);
                    z += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                }
                z
            }
            _ => 0.0,
        }
    }

    /// Force or moment on the wall at a displacement, a velocity and the largest displacement so far.
    pub fn force(&self, [x, v, largest]: [f64; 3]) -> f64 {
        let (q, u, m) = (x / self.reach[0], v / self.reach[1], largest / self.reach[0]);
        -self.size
            * match self.form {
                Form::Spring { n } => odd(q, n),
                Form::Stop { side, g, n } => side * (side * q - g).max(0.0).powf(n),
                Form::DeadZone { g, n } => q.signum() * (q.abs() - g).max(0.0).powf(n),
                Form::Saturation { d } => (q / d).tanh(),
                Form::Drag { n } => odd(u, n),
                Form::Opening { p, n } => q.abs().powf(p) * odd(u, n),
                Form::DragSaturation { s } => (u / s).tanh(),
                Form::OneWay { side, n } => side * (side * u).max(0.0).powf(n),
                Form::Snapping { d } => (q / d) / (1.0 + (q / d).powi(2)),
                Form::Hardening { d } => q.signum() * ((q.abs() / d).exp() - 1.0),
                Form::NearRest { d } => u * (-(q / d).powi(2)).exp(),
                Form::Slipping { s } => (u / s) / (1.0 + (u / s).powi(2)),
                Form::Teeth { d } => {
                    let a = q.abs() / d;
                    q.signum()
                        * (a.min(1.0) - (a - 1.0).clamp(0.0, 2.0) + (a - 3.0).clamp(0.0, 2.0)
                            - (a - 5.0).max(0.0))
                }
                Form::Weakening { g } => -q * m / (g + m),
                Form::Secant { g } => q / (g + m),
                Form::Slack { a } => q.signum() * (q.abs() - a * m).max(0.0),
                Form::Relaxing { .. } | Form::Yielding { .. } => m,
            }
    }

    /// Whether a search for sums of powers, thresholds and saturations can write it.
    pub fn is_in_grammar(&self) -> bool {
        !matches!(
            self.form,
            Form::Snapping { .. }
                | Form::Hardening { .. }
                | Form::NearRest { .. }
                | Form::Slipping { .. }
                | Form::Teeth { .. }
        )
    }

    /// Its formula, every number a parameter.
    pub fn formula(&self) -> String {
        self.spellings().swap_remove(0)
    }

    /// The ways in which an answer may write it, numbers as parameters first.
    pub fn spellings(&self) -> Vec<String> {
        let [x, v] = self.site.variables();
        let side = |side: f64| if side > 0.0 { ("-", "") } else { ("", "-") };
        let odd = |x: &str, n: f64, c: &str| {
            let mut all = vec![format!("-{c}*sign({x})*abs({x})**n")];
            all.extend(exact_odd(x, n).map(|exact| format!("-{c}*{exact}")));
            all
        };
        let beyond = |start: &str, base: &str, n: f64| {
            let mut all = vec![format!("{start}{base}**n")];
            all.extend(exact_power(base, n).map(|exact| format!("{start}{exact}")));
            all
        };
        match self.form {
            Form::Spring { n } => odd(x, n, "k"),
            Form::Drag { n } => odd(v, n, "c"),
            Form::Stop { side: s, n, .. } => {
                let (sign, inner) = side(s);
                beyond(&format!("{sign}k*"), &format!("max({inner}{x}-g,0)"), n)
            }
            Form::DeadZone { n, .. } => beyond(&format!("-k*sign({x})*"), &format!("max(abs({x})-g,0)"), n),
            Form::OneWay { side: s, n } => {
                let (sign, inner) = side(s);
                beyond(&format!("{sign}c*"), &format!("max({inner}{v},0)"), n)
            }
            Form::Opening { p, n } => {
                let x = std::iter::once(format!("abs({x})**p")).chain(exact_power(&format!("abs({x})"), p));
                let v = std::iter::once(format!("sign({v})*abs({v})**n")).chain(exact_odd(v, n));
                let v = v.collect::<Vec<_>>();
                x.flat_map(|x| v.iter().map(move |v| format!("-c*{x}*{v}")).collect::<Vec<_>>()).collect()
            }
            Form::Saturation { .. } => vec![format!("-f*tanh({x}/d)")],
            Form::DragSaturation { .. } => vec![format!("-f*tanh({v}/s)")],
            Form::Snapping { .. } => vec![format!("-f*({x}/d)/(1+({x}/d)**2)")],
            Form::Hardening { .. } => vec![format!("-f*sign({x})*(exp(abs({x})/d)-1)")],
            Form::NearRest { .. } => vec![format!("-c*{v}*exp(-({x}/d)**2)")],
            Form::Slipping { .. } => vec![format!("-f*({v}/s)/(1+({v}/s)**2)")],
            Form::Teeth { .. } => {
                let tooth = |from: f64, to: f64| {
                    format!("(max(min({x}/d-{from},{to}),0)+min(max({x}/d+{from},-{to}),0))")
                };
                let last = format!("(max({x}/d-5,0)+min({x}/d+5,0))");
                vec![format!("-f*(max(min({x}/d,1),-1)-{}+{}-{last})", tooth(1.0, 2.0), tooth(3.0, 2.0))]
            }
            Form::Weakening { .. } => vec![format!("k*{x}*x_max/(g+x_max)")],
            Form::Secant { .. } => vec![format!("-f*{x}/(g+x_max)")],
            Form::Slack { .. } => vec![format!("-k*sign({x})*max(abs({x})-a*x_max,0)")],
            Form::Relaxing { .. } => vec!["-k*z".to_owned()],
            Form::Yielding { .. } => vec!["-f*z".to_owned()],
        }
    }

    /// Its parameters: name, value and unit.
    pub fn parameters(&self) -> Vec<(&'static str, f64, String)> {
        let [force, displacement, velocity] = self.site.units();
        let [x, v] = self.reach;
        // A radian is a pure number in the unit of a coefficient.
        let per_x = |power: &str| if self.site == Site::Top { format!("/m**{power}") } else { String::new() };
        let per_v = |power: &str| {
            if self.site == Site::Top { format!("*(s/m)**{power}") } else { format!("*s**{power}") }
        };
        let pure = |name: &'static str, n: f64| (name, n, "1".to_owned());
        let at = |name: &'static str, share: f64| (name, share * x, displacement.to_owned());
        let speed = |name: &'static str, share: f64| (name, share * v, velocity.to_owned());
        let size =
            |name: &'static str, over: f64, per: String| (name, self.size / over, format!("{force}{per}"));
        match self.form {
            Form::Spring { n } => vec![size("k", x.powf(n), per_x("n")), pure("n", n)],
            Form::Stop { g, n, .. } | Form::DeadZone { g, n } => {
                vec![size("k", x.powf(n), per_x("n")), at("g", g), pure("n", n)]
            }
            Form::Drag { n } | Form::OneWay { n, .. } => vec![size("c", v.powf(n), per_v("n")), pure("n", n)],
            Form::Opening { p, n } => vec![
                size("c", x.powf(p) * v.powf(n), format!("{}{}", per_x("p"), per_v("n"))),
                pure("p", p),
                pure("n", n),
            ],
            Form::Saturation { d } | Form::Snapping { d } | Form::Hardening { d } | Form::Teeth { d } => {
                vec![size("f", 1.0, String::new()), at("d", d)]
            }
            Form::Weakening { g } => vec![size("k", x, per_x("1")), at("g", g)],
            Form::Secant { g } => vec![size("f", 1.0, String::new()), at("g", g)],
            Form::Slack { a } => vec![size("k", x, per_x("1")), pure("a", a)],
            Form::Relaxing { tau } => vec![size("k", x, per_x("1")), ("tau", tau * x / v, "s".to_owned())],
            Form::Yielding { d, n } => vec![size("f", 1.0, String::new()), at("d", d), pure("n", n)],
            Form::NearRest { d } => vec![size("c", v, per_v("1")), at("d", d)],
            Form::DragSaturation { s } | Form::Slipping { s } => {
                vec![size("f", 1.0, String::new()), speed("s", s)]
            }
        }
    }

    /// The rate of the state that it carries along, and its unit.
    fn rate(&self) -> Option<(&'static str, &'static str)> {
        match self.form {
            Form::Relaxing { .. } => Some(("v-z/tau", "m")),
            Form::Yielding { .. } => Some(("v/d*(1-abs(z)**n*(1+sign(v*z))/2)", "1")),
            _ => None,
        }
    }

    /// As an effect of a wall file.
    pub fn effect(&self) -> toml::Table {
        let parameter = |(name, value, unit): (&'static str, f64, String)| {
            let mut table = toml::Table::new();
            table.insert("value".into(), value.into());
            table.insert("unit".into(), unit.into());
            (name.to_owned(), toml::Value::Table(table))
        };
        let parameters: toml::Table = self.parameters().into_iter().map(parameter).collect();
        let mut effect = toml::Table::new();
        effect.insert("kind".into(), "formula".into());
        effect.insert("place".into(), self.site.name().into());
        effect.insert(self.site.key().into(), self.formula().into());
        if let Some((rate, unit)) = self.rate() {
            let mut state = toml::Table::new();
            state.insert("rate".into(), rate.into());
            state.insert("start".into(), 0.0.into());
            state.insert("unit".into(), unit.into());
            let states = toml::Table::from_iter([("z".to_owned(), toml::Value::Table(state))]);
            effect.insert("states".into(), toml::Value::Table(states));
        }
        effect.insert("parameters".into(), toml::Value::Table(parameters));
        effect
    }

    /// As answers tell it.
    pub fn told(&self) -> Value {
        let values: Map<String, Value> =
            self.parameters().into_iter().map(|(name, value, _)| (name.to_owned(), json!(value))).collect();
        let mut told = json!({
            "kind": "formula",
            "place": self.site.name(),
            "formula": self.formula(),
            "spellings": self.spellings(),
            "in_grammar": self.is_in_grammar(),
            "parameters": values,
        });
        if let Some((rate, unit)) = self.rate() {
            told["states"] = json!([{ "name": "z", "rate": rate, "start": 0.0, "unit": unit }]);
        }
        told
    }
}

/// A power with the sign of its base as people write it, where its exponent is such a number.
fn exact_odd(x: &str, n: f64) -> Option<String> {
    match n {
        1.0 => Some(x.to_owned()),
        2.0 => Some(format!("{x}*abs({x})")),
        3.0 | 5.0 | 7.0 => Some(format!("{x}**{n}")),
        _ => exact_power(&format!("abs({x})"), n).map(|power| format!("sign({x})*{power}")),
    }
}

/// A power of what is never negative as people write it, where its exponent is such a number.
fn exact_power(base: &str, n: f64) -> Option<String> {
    match n {
        0.5 => Some(format!("sqrt({base})")),
        1.0 => Some(base.to_owned()),
        _ if (2.0 * n).fract() == 0.0 => Some(format!("{base}**{n}")),
        _ => None,
    }
}
