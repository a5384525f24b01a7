//! Quantities derived from a scenario: conflict zones, lane widths, schedules, and the effect of the seed.

pub(crate) mod narrowest_lane;
pub(crate) mod script_contact;
pub(crate) mod seed_dependence;
pub(crate) mod swept_width;
pub(crate) mod timetable;
