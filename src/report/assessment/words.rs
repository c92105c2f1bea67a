//! Words of the page in two languages, and what it says of its assumptions.

use crate::assessment::wall::{Assessed, Language, SuiteNote};
use mrbd_assessment::{Agreement, Governing};

/// The language of a page.
#[derive(Debug, Clone, Copy)]
pub struct Words(pub Language);

impl Words {
    /// One of two texts.
    pub fn say(self, english: &str, italian: &str) -> String {
        match self.0 {
            Language::En => english,
            Language::It => italian,
        }
        .to_owned()
    }

    /// A mechanism.
    pub fn governing(self, mechanism: Governing) -> String {
        match mechanism {
            Governing::OneBlock => {
                self.say("overturning of the whole wall", "ribaltamento semplice della parete")
            }
            Governing::UpperBody => self
                .say("overturning of what is above the crack", "ribaltamento della parte sopra la fessura"),
            Governing::VerticalBending => {
                self.say("vertical bending between supports", "flessione verticale tra vincoli")
            }
            Governing::Restrained => self.say(
                "both bodies on the springs at the top",
                "due blocchi, trattenuti in sommità da un vincolo cedevole",
            ),
        }
    }
}

/// What to know first.
pub fn notes(w: Words, assessed: &Assessed) -> Vec<String> {
    let a = &assessed.assessment;
    let mut notes: Vec<String> = parted(w, a.agreement).into_iter().collect();
    notes.extend(assessed.suite.iter().flat_map(|suite| of_suite(w, suite)));
    if !a.capacity.vanishes {
        notes.push(w.say(
            "The multiplier does not vanish; d_0 is where the wall counts as fallen.",
            "Il moltiplicatore non si annulla; d_0 è lo spostamento a cui la parete è considerata crollata.",
        ));
    }
    if a.mechanism == Governing::Restrained {
        let first = a.capacity.alpha_first;
        notes.push(w.say(
            &format!("The springs at the top give: a first joint opens at α = {first:.4} already; α_0 is the largest multiplier that the wall bears."),
            &format!("Il vincolo in sommità cede: una prima cerniera si apre già per α = {first:.4}; α_0 è il massimo moltiplicatore sopportato."),
        ));
    }
    notes
}

/// Where the static check and the dynamics part.
fn parted(w: Words, agreement: Option<Agreement>) -> Option<String> {
    match agreement? {
        Agreement::StaticRefuses => Some(w.say(
            "The static check refuses what the dynamics accept.",
            "La verifica statica rifiuta ciò che la dinamica accetta.",
        )),
        Agreement::DynamicRefuses => Some(w.say(
            "The static check accepts what the dynamics refuse.",
            "La verifica statica accetta ciò che la dinamica rifiuta.",
        )),
        Agreement::BothAccept | Agreement::BothRefuse => None,
    }
}

/// Records that are generated, or not compatible with the site.
fn of_suite(w: Words, suite: &SuiteNote) -> Vec<String> {
    let generated = suite.generated.then(|| {
        w.say(
            "The records are generated, not natural: C8.7.1.2.1.9 asks for natural ones.",
            "Gli accelerogrammi sono generati, non naturali: la C8.7.1.2.1.9 richiede accelerogrammi naturali.",
        )
    });
    let [low, high] = suite.deviation.map(|d| 100.0 * d);
    let apart = (!suite.compatible).then(|| {
        w.say(
            &format!("The mean spectrum lies {low:+.0} % to {high:+.0} % about the code's: not compatible."),
            &format!(
                "Lo spettro medio scarta da {low:+.0} % a {high:+.0} % da quello di norma: non è compatibile."
            ),
        )
    });
    generated.into_iter().chain(apart).collect()
}

/// What is assumed, and what is not checked.
pub fn assumptions(w: Words) -> Vec<String> {
    vec![
        w.say(
            "Rigid bodies that do not slide. The multiplier follows finite rotations. Of two sides the weaker one counts.",
            "Corpi rigidi senza scorrimento. Il moltiplicatore segue rotazioni finite. Dei due versi conta il più debole.",
        ),
        w.say(
            "The mass m_d at the top is carried and pushes (P_k); m_dp pushes only (Q_k). Springs at the top act in the capacity curve; friction and dampers do not.",
            "La massa m_d in sommità è portata e spinge (P_k); m_dp spinge soltanto (Q_k). I vincoli elastici agiscono nella curva di capacità; attrito e smorzatori no.",
        ),
        w.say(
            "a_g,SLV is solved with S_S and T_D following a_g; F_0 and T_C* stay. In C7.2.6 the damping under the root is relative.",
            "a_g,SLV è ottenuta con S_S e T_D funzioni di a_g; F_0 e T_C* restano fissi. Nella C7.2.6 lo smorzamento sotto radice è relativo.",
        ),
        w.say(
            "The dynamics use the wall as its file has it, without the confidence factor; energy is lost at impacts by its coefficients of restitution.",
            "La dinamica usa la parete come descritta, senza fattore di confidenza; l'energia si dissipa negli urti secondo i coefficienti di restituzione.",
        ),
        w.say(
            "Not checked: quality of the masonry and its disintegration, sliding and shear, detachment from walls that join it, the first crack, anchors and bearings, effects of other mechanisms.",
            "Non verificati: qualità muraria e disgregazione, scorrimento e taglio, distacco dalle pareti ortogonali, prima fessurazione, ancoraggi e appoggi, interazione con altri meccanismi.",
        ),
    ]
}
