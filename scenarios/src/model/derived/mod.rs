//! What follows from a scenario: where ways meet, how wide the lanes are, when something comes, and what the seed decides.

pub(crate) mod conflict_zones;
pub(crate) mod detector_line;
pub(crate) mod narrowest_lane;
pub(crate) mod plan_deadlines;
pub(crate) mod seed_dependence;
pub(crate) mod swept_width;
pub(crate) mod timetable;
