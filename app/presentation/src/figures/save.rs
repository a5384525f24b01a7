//! Pictures as files.

use std::path::Path;

use crate::plot::Sketch;

/// Writes pictures as `name.svg` and `name.png`; from the second on with a number.
///
/// # Errors
/// In words, if one cannot be drawn or written.
pub(super) fn save(pictures: &[Sketch], folder: &Path, name: &str) -> Result<(), String> {
    for (index, picture) in pictures.iter().enumerate() {
        let name = if index == 0 { name.to_owned() } else { format!("{name}-{}", index + 1) };
        picture.save(folder, &name).map_err(|error| error.to_string())?;
    }
    Ok(())
}
