//! How long a vehicle is asked that does not accept.
//!
//! The source asks the next vehicle when the acceptance probability has not risen by more than `ε` five times in a row
//! (section 6.5). That also happens at steady acceptance, so a low probability is required too. Beside this count there is a price:
//! an ego that asks drives as if it were granted what it asks for, and with each refusal the fallback that it will need becomes dearer.
//! Where that goes beyond a share of what the cheapest fallback cost since its first request, it stops asking. Both are
//! free of units and scale.
//!
//! Neither begins before the other could have answered (`answer_s`): what it does until then says nothing about what it was asked.

use super::settings::Settings;

/// An acceptance below this counts as a refusal.
const REFUSAL_ACCEPTANCE: f64 = 0.5;

/// What patience with one vehicle remembers.
#[derive(Clone, Debug, Default)]
pub(super) struct Patience {
    last_acceptance: Option<f64>,
    answers: usize,
    steps_without_progress: usize,
}

impl Patience {
    /// Counts one more step, and returns whether the vehicle has had its `answer_steps`.
    pub(super) fn has_answered(&mut self, answer_steps: usize) -> bool {
        self.answers += 1;
        self.answers > answer_steps
    }

    /// Whether the vehicle is not to be asked any more, after an answer and where the fallback has become `dearer` by this share.
    pub(super) fn ends(&mut self, accepted: f64, dearer: f64, settings: &Settings) -> bool {
        let no_progress = accepted < REFUSAL_ACCEPTANCE
            && self.last_acceptance.is_some_and(|last| accepted - last <= settings.epsilon);
        self.steps_without_progress = if no_progress { self.steps_without_progress + 1 } else { 0 };
        self.last_acceptance = Some(accepted);
        self.steps_without_progress >= settings.patience_steps
            || no_progress && dearer > settings.retreat_dearer_at_most
    }
}

/// By which share the fallback has become dearer than the cheapest one since the first request.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FallbackPrice {
    least_cost: Option<f64>,
}

impl FallbackPrice {
    /// The share, with what the fallback costs now; 0 without a fallback.
    pub(super) fn dearer(&mut self, cost: Option<f64>) -> f64 {
        let Some(cost) = cost else { return 0.0 };
        let least = self.least_cost.map_or(cost, |least| least.min(cost));
        self.least_cost = Some(least);
        if cost > least { cost / least - 1.0 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The answer at which patience ends, of acceptances and costs of the fallback.
    fn ends_at(settings: &Settings, answers: &[(f64, f64)]) -> Option<usize> {
        let (mut patience, mut price) = (Patience::default(), FallbackPrice::default());
        answers.iter().position(|(accepted, cost)| patience.ends(*accepted, price.dearer(Some(*cost)), settings))
    }

    #[test]
    fn five_refusals_without_progress_end_it() {
        let refused = [(0.0, 2.0); 10];
        assert_eq!(ends_at(&Settings::default(), &refused), Some(5));
        let rising: Vec<_> = (0..10).map(|step| (0.04 * f64::from(step), 2.0)).collect();
        assert_eq!(ends_at(&Settings::default(), &rising), None);
        let accepted = [(0.9, 2.0); 10];
        assert_eq!(ends_at(&Settings::default(), &accepted), None);
    }

    #[test]
    fn a_refusal_that_makes_the_fallback_dearer_ends_it_at_once() {
        let settings = Settings::default();
        let growing = |accepted: f64| [(accepted, 2.0), (accepted, 2.19), (accepted, 2.21), (accepted, 2.4)];
        assert_eq!(ends_at(&settings, &growing(0.0)), Some(2));
        assert_eq!(ends_at(&settings, &growing(0.9)), None, "who accepts is asked on, whatever a fallback would cost");
        let unmoved = Settings { retreat_dearer_at_most: 1e6, ..settings };
        assert_eq!(ends_at(&unmoved, &growing(0.0)), None);
    }

    #[test]
    fn the_price_is_counted_from_the_cheapest_fallback() {
        let mut price = FallbackPrice::default();
        let dearer =
            [Some(2.0), Some(3.0), Some(1.0), None, Some(1.5), Some(0.0), Some(0.0)].map(|cost| price.dearer(cost));
        assert_eq!(dearer, [0.0, 0.5, 0.0, 0.0, 0.5, 0.0, 0.0]);
        assert_eq!(price.dearer(Some(1.0)), f64::INFINITY, "dearer than a fallback that cost nothing");
    }
}
