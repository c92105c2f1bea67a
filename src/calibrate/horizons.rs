//! The horizons of the stronger search, from windows to the free-running tests, and the names of their stages.

/// How much of the tests is simulated in one go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Horizon {
    /// Windows from each so many-th stretch without impacts.
    Windows(usize),
    /// The first share of the motion.
    First(f64),
    /// The free-running test: Eq. 8.
    Whole,
}

/// Where both routes begin.
pub(super) const BEGINNING: Horizon = Horizon::Windows(1);
/// How each route leads from there to the whole.
pub(super) const ROUTES: [(&str, &[Horizon]); 2] = [
    ("by windows", &[Horizon::Windows(3), Horizon::Windows(9)]),
    ("from rest", &[Horizon::First(0.1), Horizon::First(0.25), Horizon::First(0.5), Horizon::First(0.75)]),
];
/// Beginnings at most.
pub(super) const MOST_BEGINNINGS: usize = 5;

/// Names under which the simulations of a search's stages are kept, in their order; the last, CMA-ES over the
/// free-running tests, has the search's own name.
pub(super) fn stage_names(method: &str) -> Vec<String> {
    let of_beginning = |number: usize| {
        let of_route = move |(route, horizons): &(&str, &[Horizon])| {
            let stages = horizons.iter().chain([&Horizon::Whole]);
            stages.map(|horizon| name(method, number, route, *horizon)).collect::<Vec<_>>()
        };
        std::iter::once(name(method, number, "", BEGINNING)).chain(ROUTES.iter().flat_map(of_route))
    };
    (0..MOST_BEGINNINGS).flat_map(of_beginning).chain([method.to_owned()]).collect()
}

/// The name of one stage of the `number`-th beginning, from 0.
pub(super) fn name(method: &str, number: usize, route: &str, horizon: Horizon) -> String {
    let beginning = if number == 0 { String::new() } else { format!(" {}", number + 1) };
    match horizon {
        Horizon::Windows(reach) => format!("{method}{beginning} windows {reach}"),
        Horizon::First(share) => format!("{method}{beginning} first {}%", 100.0 * share),
        Horizon::Whole => format!("{method}{beginning} {route}"),
    }
}
