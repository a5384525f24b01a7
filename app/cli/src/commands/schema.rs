//! `interplay schema`

use clap::Args;
use interplay_scenarios::Registry;

use crate::output::error::ExitStatus;
use crate::output::printed;

/// Print the JSON Schema of the scenario format, from which editors complete and explain keys.
///
/// A scenario names it in its first line, `#:schema interplay.schema.json`, which editors with Taplo ("Even Better TOML")
/// read. It is the schema that scenarios are checked against.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  interplay schema > interplay.schema.json")]
pub(crate) struct Schema {}

impl Schema {
    pub(crate) fn execute(self, registry: &Registry) -> ExitStatus {
        printed(&text(registry))
    }
}

/// The schema as it is written into files.
pub(crate) fn text(registry: &Registry) -> String {
    format!("{:#}\n", registry.schema())
}
