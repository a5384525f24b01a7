//! Numbers that explain plans. Each planner declares in its own folder which quantities it reports, what they mean and which
//! of them belong together; recordings, figures and reports read nothing else.

/// A quantity that planners report with their plans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiagnosticQuantity {
    /// Name in words, by which its curve is called; unique among the quantities of a planner.
    pub name: &'static str,
    /// Unit; empty for a number without dimension.
    pub unit: &'static str,
    /// The values that the quantity can take.
    pub values: ValueSet,
}

/// The set of values that a quantity can take, which decides how its curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueSet {
    /// Any real number.
    Real,
    /// Real numbers from 0 on.
    NonNegative,
    /// Natural numbers and 0.
    Count,
    /// Probabilities, from 0 to 1.
    Probability,
    /// Numbers from 0 to 1 that are no probabilities.
    Share,
    /// 0 for false and 1 for true.
    Switch,
}

/// A quantity with the value that a planner reports of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnostic {
    /// The reported quantity.
    pub quantity: DiagnosticQuantity,
    /// The value, in the quantity's unit.
    pub value: f64,
}

/// Quantities that are shown together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiagnosticPanel {
    /// The title above or beside the curves.
    pub title: &'static str,
    /// The quantities, in the order of their colours.
    pub quantities: &'static [DiagnosticQuantity],
}

/// How a kind of planner explains its plans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explanation {
    /// Every quantity that the planner reports besides [`COMMON_QUANTITIES`].
    pub quantities: &'static [DiagnosticQuantity],
    /// The panels of a recording, each with the unit in its title where it has one.
    pub panels: &'static [DiagnosticPanel],
    /// The plots of a figure. All quantities of a plot have the same unit, which the figure adds to the title.
    pub plots: &'static [DiagnosticPanel],
    /// What to look for in the panels, as Markdown; empty where there is nothing to say.
    pub guide: &'static str,
}

impl DiagnosticQuantity {
    /// A quantity with its name, its unit and the values that it can take.
    pub const fn new(name: &'static str, unit: &'static str, values: ValueSet) -> Self {
        DiagnosticQuantity { name, unit, values }
    }

    /// This quantity with a value, in its unit.
    pub const fn is(self, value: f64) -> Diagnostic {
        Diagnostic { quantity: self, value }
    }

    /// Whether the quantity is only ever 0 or 1.
    pub fn is_switch(&self) -> bool {
        self.values == ValueSet::Switch
    }
}

impl ValueSet {
    /// The lowest and the highest value, where both are known.
    pub fn bounds(self) -> Option<[f64; 2]> {
        match self {
            ValueSet::Probability | ValueSet::Share | ValueSet::Switch => Some([0.0, 1.0]),
            ValueSet::Real | ValueSet::NonNegative | ValueSet::Count => None,
        }
    }

    /// Whether a number belongs to the set of values.
    pub fn contains(self, value: f64) -> bool {
        match self {
            ValueSet::Real => !value.is_nan(),
            ValueSet::NonNegative => value >= 0.0,
            ValueSet::Count => value >= 0.0 && value.fract() == 0.0,
            ValueSet::Probability | ValueSet::Share => (0.0..=1.0).contains(&value),
            ValueSet::Switch => value == 0.0 || value == 1.0,
        }
    }
}

impl DiagnosticPanel {
    /// The title with the unit in brackets, `[–]` for numbers without dimension.
    pub fn title_with_unit(&self) -> String {
        let unit = self.quantities.first().map_or("", |quantity| quantity.unit);
        format!("{} [{}]", self.title, if unit.is_empty() { "–" } else { unit })
    }

    /// The range that all quantities of the panel share, if each of them has bounds.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        let mut bounds = self.quantities.iter().map(|quantity| quantity.values.bounds());
        let first = bounds.next()??;
        bounds.all(|other| other == Some(first)).then_some(first)
    }
}

impl Explanation {
    /// The explanation of a planner that reports nothing but [`COMMON_QUANTITIES`].
    pub const NONE: Explanation = Explanation { quantities: &[], panels: &[], plots: &[], guide: "" };
}

/// The cost of the trajectory problem at its optimum.
pub const COST: DiagnosticQuantity = DiagnosticQuantity::new("cost", "", ValueSet::Real);
/// The cost of the cheapest plan of another homotopy class, where one was found.
pub const RUNNER_UP_COST: DiagnosticQuantity = DiagnosticQuantity::new("cost of the runner-up", "", ValueSet::Real);
/// By how much a plan enters the safety ellipses, summed over its steps (of `1 − d²`).
pub const SAFETY_SLACK: DiagnosticQuantity = DiagnosticQuantity::new("safety slack", "", ValueSet::NonNegative);
/// Number of steps of a plan at which a safety ellipse is touched.
pub const STEPS_AT_ELLIPSE: DiagnosticQuantity = steps("steps at a safety ellipse");
/// Number of steps of a plan at which a corner is at the edge of the road.
pub const STEPS_AT_EDGE: DiagnosticQuantity = steps("steps at a road edge");
/// Number of steps of a plan at which the acceleration or the steering is at a bound.
pub const STEPS_AT_INPUT_BOUND: DiagnosticQuantity = steps("steps at an input bound");
/// Number of steps of a plan at which the speed is at a bound.
pub const STEPS_AT_SPEED_BOUND: DiagnosticQuantity = steps("steps at a speed bound");

/// The quantities that any planner may report that optimises a trajectory.
pub const COMMON_QUANTITIES: &[DiagnosticQuantity] =
    &[COST, RUNNER_UP_COST, SAFETY_SLACK, STEPS_AT_ELLIPSE, STEPS_AT_EDGE, STEPS_AT_INPUT_BOUND, STEPS_AT_SPEED_BOUND];

/// The panels of a recording that show all planners together: what holds plans back, and what another order would cost.
pub const COMMON_PANELS: &[DiagnosticPanel] = &[
    DiagnosticPanel {
        title: "What holds a plan back [steps of it]",
        quantities: &[STEPS_AT_ELLIPSE, STEPS_AT_EDGE, STEPS_AT_INPUT_BOUND, STEPS_AT_SPEED_BOUND],
    },
    DiagnosticPanel { title: "Cost of the plan and of its runner-up [–]", quantities: &[COST, RUNNER_UP_COST] },
];

const fn steps(name: &'static str) -> DiagnosticQuantity {
    DiagnosticQuantity::new(name, "steps", ValueSet::Count)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROBABILITY: DiagnosticQuantity = DiagnosticQuantity::new("p", "", ValueSet::Probability);
    const SPEED: DiagnosticQuantity = DiagnosticQuantity::new("speed", "m/s", ValueSet::Real);

    #[test]
    fn a_panel_has_bounds_where_all_its_quantities_have_the_same() {
        let panel = |quantities| DiagnosticPanel { title: "title", quantities };
        assert_eq!(panel(&[PROBABILITY, PROBABILITY]).bounds(), Some([0.0, 1.0]));
        assert_eq!(panel(&[PROBABILITY, COST]).bounds(), None);
        assert_eq!(panel(&[]).bounds(), None);
        assert_eq!(panel(&[SPEED]).title_with_unit(), "title [m/s]");
        assert_eq!(panel(&[PROBABILITY]).title_with_unit(), "title [–]");
    }

    #[test]
    fn values_outside_a_set_are_told() {
        for (values, inside, outside) in [
            (ValueSet::Real, -1.5, f64::NAN),
            (ValueSet::NonNegative, 0.0, -1e-9),
            (ValueSet::Count, 3.0, 2.5),
            (ValueSet::Probability, 1.0, 1.1),
            (ValueSet::Share, 0.3, -0.1),
            (ValueSet::Switch, 1.0, 0.5),
        ] {
            assert!(values.contains(inside) && !values.contains(outside), "{values:?}");
        }
    }
}
