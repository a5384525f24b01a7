//! Comparisons of planners, and of versions, as text and as a page.

mod page;
mod rows;
mod text;

pub use page::{comparison_page, version_comparison_page};
pub use text::{comparison, version_comparison};
