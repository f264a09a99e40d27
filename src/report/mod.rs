//! One HTML page of a run: the answer first, the shots in a view that turns, tables that sort, and
//! the plots.
//!
//! The page loads nothing from elsewhere, and all names in it are escaped.

pub mod best_shot_page;
mod best_shot_table;
pub mod coach_sheet;
pub mod fit_page;
mod html_table;
pub mod page;
mod page_data;
pub mod physics_section;
pub mod poster_page;
mod report_error;
mod sensitivity_table;
mod shot_in_words;
pub mod sweep_page;
pub mod team_page;

pub use html_table::HtmlTable;
pub use page_data::{Scene, court_record};
pub use report_error::ReportError;
pub use shot_in_words::ReportShot;
