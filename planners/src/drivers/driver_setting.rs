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
        /// The key of the setting, as a scenario file calls it.
        key: &'static str,
        /// The value of the setting.
        steps: usize,
        /// Number of steps of a plan.
        horizon_steps: usize,
        /// Why a plan has to reach further.
        because: &'static str,
    },
    /// A lower bound is above its upper bound.
    #[error("({lower}) is above `{upper_key}` ({upper})")]
    BoundsCrossed {
        /// The key of the lower bound.
        key: &'static str,
        /// The value of the setting.
        lower: f64,
        /// The key of the upper bound.
        upper_key: &'static str,
        /// The value of the setting.
        upper: f64,
    },
    /// Any other setting that does not fit.
    #[error("{reason}")]
    Unfit {
        /// The key of the setting, as a scenario file calls it.
        key: &'static str,
        /// What is wrong, as the end of a sentence that begins with the setting's path.
        reason: String,
        /// What to state instead, as the help of an error message.
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

    /// What to state instead, as the help of an error message.
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
