//! What a driver knows of the others.

/// What the predictions of the others in a scene are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Knowledge {
    /// The plans of vehicles that tell them (the assumption of the dissertation).
    #[default]
    Plans,
    /// What their motion leads one to expect ([`SeenMotion`](crate::drivers::SeenMotion)).
    Motion {
        /// How many steps ago the others were observed: the reaction time of the driver. Their states are continued to the present.
        late_steps: usize,
    },
}

impl Knowledge {
    /// Whether the driver knows no plans.
    pub fn is_of_motion(self) -> bool {
        matches!(self, Knowledge::Motion { .. })
    }
}
