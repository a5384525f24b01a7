//! How far an optimiser looks beyond the homotopy class in which it begins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which homotopy classes (before or behind another vehicle, to its left or to its right) are looked at for a cheaper plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HomotopySearch {
    /// None: a plan stays in the class of the plan before.
    Off,
    /// Those that simple motions reach, as long as they promise to be cheaper.
    #[default]
    Classes,
    /// All that can be found: descents from every simple motion and from motions spread over all inputs, none of them given up. A
    /// plan that touches another vehicle's ellipse takes seconds. It shows whether an outcome results from a missed optimum.
    Global,
}
