//! The font of all pictures.

/// DejaVu Sans as a TrueType file.
pub static FONT_BYTES: &[u8] = include_bytes!("../../../assets/fonts/DejaVuSans.ttf");
