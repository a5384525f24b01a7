//! Pictures as files.

use std::path::Path;

use crate::plot::{Drawing, PlotError};

/// Writes pictures as `name.svg` and `name.png`; from the second on with a number.
///
/// # Errors
/// [`PlotError`], if one cannot be drawn or written.
pub(super) fn save(pictures: &[Drawing], folder: &Path, name: &str) -> Result<(), PlotError> {
    for (index, picture) in pictures.iter().enumerate() {
        let name = if index == 0 { name.to_owned() } else { format!("{name}-{}", index + 1) };
        picture.save(folder, &name)?;
    }
    Ok(())
}
