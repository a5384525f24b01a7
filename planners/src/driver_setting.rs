//! Settings of a driver that contradict each other or the horizon.

use thiserror::Error;

/// A setting of a driver that is admissible alone, but not beside another one.
///
/// Its text says what is wrong; [`DriverSettingError::key`] and [`DriverSettingError::remedy`] say where and what would work.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DriverSettingError {
    /// A number of steps reaches to the end of the horizon or beyond.
    #[error("({steps}) must be below `horizon_steps` ({horizon_steps})")]
    BeyondHorizon {
        /// The setting.
        key: &'static str,
        /// Its value.
        steps: usize,
        /// Steps of a plan.
        horizon_steps: usize,
        /// Why a plan has to reach further.
        because: &'static str,
    },
    /// A lower bound is above its upper bound.
    #[error("({lower}) is above `{upper_key}` ({upper})")]
    BoundsCrossed {
        /// The lower bound.
        key: &'static str,
        /// Its value.
        lower: f64,
        /// The upper bound.
        upper_key: &'static str,
        /// Its value.
        upper: f64,
    },
    /// Any other setting that does not fit.
    #[error("{reason}")]
    Unfit {
        /// The setting.
        key: &'static str,
        /// What is wrong, as the end of a sentence that begins with the setting's path.
        reason: String,
        /// What would work.
        remedy: String,
    },
}

impl DriverSettingError {
    /// The setting to change, as a scenario file calls it.
    pub fn key(&self) -> &'static str {
        match self {
            DriverSettingError::BeyondHorizon { key, .. }
            | DriverSettingError::BoundsCrossed { key, .. }
            | DriverSettingError::Unfit { key, .. } => key,
        }
    }

    /// What is wrong with the value, in a few words.
    pub fn label(&self) -> &'static str {
        match self {
            DriverSettingError::BeyondHorizon { .. } => "too long",
            DriverSettingError::BoundsCrossed { .. } => "too large",
            DriverSettingError::Unfit { .. } => "does not fit",
        }
    }

    /// What would work.
    pub fn remedy(&self) -> String {
        match self {
            DriverSettingError::BeyondHorizon { because, .. } => (*because).to_owned(),
            DriverSettingError::BoundsCrossed { upper_key, upper, .. } => {
                format!("state at most {upper}, or raise `{upper_key}`")
            }
            DriverSettingError::Unfit { remedy, .. } => remedy.clone(),
        }
    }
}
