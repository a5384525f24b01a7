//! Interplay: planners for vehicles that interact.
pub mod conservative {
    mod settings;
    pub use settings::Settings;
}
pub mod human {
    mod settings;
    pub use settings::{Settings, Style};
}
pub mod negotiation {
    mod settings;
    pub use settings::Settings;
}
mod driver;
pub mod dynamics;
mod footprint;
mod road;
mod state;
pub use driver::Driver;
pub use footprint::{Body, EllipticalDistance, SafetyEllipse};
pub use road::{Clearance, Corridor, LaneEnd};
pub use state::{Input, State, Trajectory};
pub mod mpc {
    //! One trajectory optimiser.
    mod adjoint;
    pub mod kkt;
    mod linearise;
    mod problem;
    mod stage;
    pub use adjoint::costates;
    pub use linearise::*;
    pub use problem::*;
    pub use stage::*;
}
