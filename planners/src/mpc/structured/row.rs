//! The scalars of one inequality and their Newton steps (see the parent module for the equations).

/// Where the iteration starts: floor of the slacks, and complementarity there.
#[derive(Clone, Copy)]
pub(super) struct Start {
    slack: f64,
    complementarity: f64,
}

impl Start {
    /// Nothing is known. (0.01 for both fails now and then.)
    pub(super) const COLD: Start = Start { slack: 0.1, complementarity: 1.0 };
    /// The multipliers belong to a neighbouring problem.
    pub(super) const WARM: Start = Start { slack: 1e-3, complementarity: 1e-4 };
}

/// Slack `s` and multiplier `λ` of one inequality, violation `σ` and its multiplier `ν` if it is soft, and their steps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    pub slack: f64,
    pub multiplier: f64,
    pub violation: f64,
    pub residual: f64,
    violation_multiplier: f64,
    /// Whether `σ ≥ 0` is imposed.
    bounded: bool,
    d1: f64,
    d2: f64,
    eta1: f64,
    eta2: f64,
    slack_step: f64,
    multiplier_step: f64,
    violation_step: f64,
    violation_multiplier_step: f64,
}

impl Row {
    pub(super) fn begin(&mut self, value: f64, soft: Option<[f64; 2]>, start: Start, warm: bool) {
        let floor = |kept: f64, slack: f64| {
            let central = start.complementarity / slack;
            if warm { kept.max(central) } else { central }
        };
        self.bounded = soft.is_some_and(|[linear, _]| linear > 0.0);
        if self.bounded {
            self.violation = if warm { self.violation.max(start.slack) } else { start.slack };
            self.violation_multiplier = floor(self.violation_multiplier, self.violation);
        } else {
            self.violation = if soft.is_some() { (-value).max(0.0) } else { 0.0 };
            self.violation_multiplier = 0.0;
        }
        self.slack = (value + self.violation).max(start.slack);
        self.multiplier = floor(self.multiplier, self.slack);
    }

    /// How many complementarity products the row has.
    pub(super) fn pairs(&self) -> usize {
        1 + usize::from(self.bounded)
    }

    pub(super) fn complementarity(&self) -> f64 {
        self.slack * self.multiplier + if self.bounded { self.violation * self.violation_multiplier } else { 0.0 }
    }

    /// Complementarity after a share of the step.
    pub(super) fn complementarity_after(&self, share: f64) -> f64 {
        let own = (self.slack + share * self.slack_step) * (self.multiplier + share * self.multiplier_step);
        let violation = if self.bounded {
            (self.violation + share * self.violation_step)
                * (self.violation_multiplier + share * self.violation_multiplier_step)
        } else {
            0.0
        };
        own + violation
    }

    /// Refreshes `d₁`, `d₂` and returns `ω`, what the row adds to the Hessian.
    #[inline(always)]
    pub(super) fn weigh(&mut self, soft: Option<[f64; 2]>) -> f64 {
        self.d1 = self.multiplier / self.slack;
        self.d2 = if self.bounded { self.violation_multiplier / self.violation } else { 0.0 };
        soft.map_or(self.d1, |[_, q]| self.d1 * (q + self.d2) / (q + self.d1 + self.d2))
    }

    /// Targets of the predictor: complementarity zero.
    #[inline(always)]
    pub(super) fn aim_at_zero(&mut self) {
        self.eta1 = -self.d1 * self.residual;
        self.eta2 = 0.0;
    }

    /// Targets of the corrector: complementarity `mu`, with the predictor's second-order error.
    #[inline(always)]
    pub(super) fn aim_at(&mut self, mu: f64) {
        self.eta1 = (mu - self.slack_step * self.multiplier_step) / self.slack - self.d1 * self.residual;
        if self.bounded {
            self.eta2 = (mu - self.violation_step * self.violation_multiplier_step) / self.violation;
        }
    }

    /// `η₁ − d₁ e/D`: the multiplier that the row would take if nothing else moved.
    #[inline(always)]
    pub(super) fn pull(&self, soft: Option<[f64; 2]>) -> f64 {
        soft.map_or(self.eta1, |weights| {
            self.eta1 - self.d1 * self.pressure(weights) / (weights[1] + self.d1 + self.d2)
        })
    }

    /// `e = η₁ + η₂ − ℓ − q σ`.
    #[inline(always)]
    fn pressure(&self, [linear, q]: [f64; 2]) -> f64 {
        self.eta1 + self.eta2 - linear - q * self.violation
    }

    /// The row's part of the Newton step for `slope = g·Δz`; returns the largest relative decrease of a positive number.
    #[inline(always)]
    pub(super) fn step(&mut self, slope: f64, soft: Option<[f64; 2]>) -> f64 {
        self.violation_step =
            soft.map_or(0.0, |weights| (self.pressure(weights) - self.d1 * slope) / (weights[1] + self.d1 + self.d2));
        self.slack_step = slope + self.violation_step + self.residual;
        self.multiplier_step = self.eta1 - self.d1 * (slope + self.violation_step) - self.multiplier;
        let ratio = (-self.slack_step / self.slack).max(-self.multiplier_step / self.multiplier);
        if !self.bounded {
            return ratio;
        }
        self.violation_multiplier_step = self.eta2 - self.d2 * self.violation_step - self.violation_multiplier;
        let violation =
            (-self.violation_step / self.violation).max(-self.violation_multiplier_step / self.violation_multiplier);
        ratio.max(violation)
    }

    #[inline(always)]
    pub(super) fn advance(&mut self, share: f64) {
        self.slack += share * self.slack_step;
        self.multiplier += share * self.multiplier_step;
        self.violation += share * self.violation_step;
        if self.bounded {
            self.violation_multiplier += share * self.violation_multiplier_step;
        }
    }
}
