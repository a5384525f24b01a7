//! What goes on in a planner, as panels: which of its numbers belong together, and what to look for in them.

use interplay_scenarios::Scenario;

/// Numbers of one kind of planner that are read together.
pub struct Thought {
    /// The word for the kind of planner; `None` for all.
    pub kind: Option<&'static str>,
    /// What the panel says above them.
    pub title: &'static str,
    /// The numbers, as the planner calls them.
    pub names: &'static [&'static str],
    /// Lowest and highest value, where they are known.
    pub range: Option<[f64; 2]>,
}

/// All of them, in the order of their panels.
pub const THOUGHTS: [Thought; 9] = [
    Thought {
        kind: Some("negotiation"),
        title: "Negotiation: acceptance and concession",
        names: &["acceptance", "concession weight", "persuasion active", "safety filter"],
        range: Some([-0.05, 1.1]),
    },
    Thought {
        kind: Some("bayesian"),
        title: "Persuasion: the other's loyalty to its plan, w₁",
        names: &["other's loyalty w_1"],
        range: None,
    },
    Thought {
        kind: Some("bayesian"),
        title: "Persuasion: pull towards the other, k₁",
        names: &["attraction k_1", "conservativeness"],
        range: None,
    },
    Thought {
        kind: Some("bayesian"),
        title: "Persuasion: changes of plans, noise of the signal",
        names: &["own change alpha", "other's change beta", "belief variance"],
        range: None,
    },
    Thought {
        kind: Some("game"),
        title: "Game: who seems to pass, who means to",
        names: &["posterior of the other", "posterior of the ego", "intention p_e", "other's intention p_s"],
        range: Some([-0.05, 1.05]),
    },
    Thought {
        kind: Some("game"),
        title: "Game: what each outcome is worth",
        names: &[
            "payoff ego: both yield",
            "payoff ego: yields alone",
            "payoff ego: passes alone",
            "payoff other: both yield",
            "payoff other: yields alone",
            "payoff other: passes alone",
            "payoff: accident",
        ],
        range: None,
    },
    Thought {
        kind: Some("game"),
        title: "Game: mean speeds that show the intention [m/s]",
        names: &["expressed speed from", "expressed speed to", "mean speed"],
        range: None,
    },
    Thought {
        kind: Some("cooperative"),
        title: "Cooperation: costs of all and of each",
        names: &["cost", "own cost"],
        range: None,
    },
    Thought {
        kind: None,
        title: "What holds a plan back [steps of it]",
        names: &[
            "steps at a safety ellipse",
            "steps at a road edge",
            "steps at an input bound",
            "steps at a speed bound",
        ],
        range: None,
    },
];

/// The place of a number among those that share its panel.
pub fn place(name: &str) -> Option<usize> {
    THOUGHTS.iter().find_map(|thought| thought.names.iter().position(|other| *other == name))
}

/// The part of a path that stands for a planner's number: its name in letters, digits, `_` and `-`.
pub fn slug(name: &str) -> String {
    let allowed = |character: &char| character.is_ascii_alphanumeric() || "_- ".contains(*character);
    name.chars().filter(allowed).map(|character| if character == ' ' { '-' } else { character }).collect()
}

/// What to look for in the panels of the planners of a scenario, as Markdown.
pub fn guide(scenario: &Scenario) -> String {
    let drives = |kind: &str| scenario.vehicles.iter().any(|vehicle| vehicle.driver.kind() == kind);
    let lines = GUIDES.iter().filter(|(kind, _)| drives(kind)).map(|(_, text)| format!("\n{text}\n"));
    lines.collect()
}

const GUIDES: [(&str, &str); 5] = [
    (
        "negotiation",
        "**Negotiation.** *acceptance* near 1: the other does what the dotted proposal asks. Near 0: it refuses, and the \
         *concession weight* of the own cost falls, so that the next proposal asks for less. *persuasion active*: the plan \
         leans towards the proposal. *safety filter* at 1: the conservative input was driven instead.",
    ),
    (
        "bayesian",
        "**Bayesian persuasion.** A change of the other's plan (*beta*) lowers its believed loyalty *w_1*; then *k_1* rises and \
         the ego dares to come closer: *conservativeness* is the smallest distance of its plan, in safety ellipses. A change of \
         the own plan (*alpha*) blurs the signal (*variance*).",
    ),
    (
        "game",
        "**The game.** The *posteriors* say who seems to pass, judged by speed or time of arrival; they set the payoffs, the \
         payoffs the *intentions*. The plan's *mean speed* should lie between the expressed bounds: so the other reads the \
         intention.",
    ),
    (
        "cooperative",
        "**Cooperation.** All vehicles with this driver solve one problem; the cost of all falls as long as they agree.",
    ),
    ("conservative", "**Conservative.** It asks nobody: look at how many steps of its plan lie at a safety ellipse."),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn slugs_are_plain_and_tell_the_numbers_apart() {
        assert_eq!(slug("other's loyalty w_1"), "others-loyalty-w_1");
        assert_eq!(slug("payoff ego: both yield"), "payoff-ego-both-yield");
        let names: Vec<&str> = THOUGHTS.iter().flat_map(|thought| thought.names.iter().copied()).collect();
        let slugs: BTreeSet<String> = names.iter().map(|name| slug(name)).collect();
        assert_eq!(slugs.len(), names.len());
    }
}
