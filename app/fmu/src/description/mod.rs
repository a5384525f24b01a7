//! `modelDescription.xml`: what an importer is told of the variables, in either version of FMI.

mod fmi2;
mod fmi3;
mod unit;

pub(crate) use unit::Description;

use crate::version::FmiVersion;

/// The file.
pub(crate) fn xml(unit: &Description<'_>, version: FmiVersion) -> String {
    match version {
        FmiVersion::Two => fmi2::xml(unit),
        FmiVersion::Three => fmi3::xml(unit),
    }
}
