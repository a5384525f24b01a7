//! Quantities derived from a scenario: conflict zones, lane widths, schedules, tasks, and the effect of the seed.

pub(crate) mod crowd;
pub(crate) mod known_records;
pub(crate) mod narrowest_lane;
pub(crate) mod script_contact;
pub(crate) mod seed_dependence;
pub(crate) mod swept_width;
pub(crate) mod task;
pub(crate) mod timetable;
