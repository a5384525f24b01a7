//! Widths of the parts of a road in drawings: the same in animations, recordings, figures and on pages.

/// Width of the lines where vehicles stop or yield, in lane widths.
pub const STOP_LINE_LANES: f64 = 0.11;
/// How far the asphalt reaches beyond the edges, in lane widths.
pub const SHOULDER_LANES: f64 = 0.05;
/// Width of the verge, in lane widths.
pub const VERGE_LANES: f64 = 0.34;
/// Width of the kerb, in lane widths.
pub const KERB_LANES: f64 = 0.07;
/// Width of a line, in lane widths.
pub const LINE_LANES: f64 = 0.035;
/// Width of an arrow, in lane widths.
pub const ARROW_WIDTH_LANES: f64 = 0.07;
