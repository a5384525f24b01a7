//! When a vehicle is on the road.

/// Whether a vehicle is on the road.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Presence {
    /// It has not entered yet.
    Awaited,
    /// It is on the road.
    #[default]
    Present,
    /// It has left.
    Left,
}

impl Presence {
    /// Whether the vehicle is not on the road.
    pub fn is_absent(self) -> bool {
        self != Presence::Present
    }
}

/// The interval of time during which a scenario wants a vehicle on the road.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stay {
    /// Time at which it enters; `None` if it is there from the start \[s\].
    pub enters_s: Option<f64>,
    /// Time at which it leaves; `None` if it does not \[s\].
    pub leaves_s: Option<f64>,
    /// Whether it leaves where its route ends.
    pub leaves_at_end: bool,
    /// Whether it stops where its route ends.
    pub stops_at_end: bool,
}

impl Stay {
    /// Whether the vehicle is on the road for the whole run, whatever happens.
    pub fn is_permanent(&self) -> bool {
        Stay { stops_at_end: false, ..*self } == Stay::default()
    }

    /// The presence at the start of a run.
    pub fn presence_at_start(&self) -> Presence {
        if self.enters_s.is_some_and(|enters_s| enters_s > 0.0) { Presence::Awaited } else { Presence::Present }
    }
}
