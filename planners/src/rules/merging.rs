//! Merging from the lane beside, as from an acceleration lane: into which gap, and so when to be where the lanes meet.
//!
//! A vehicle that has to let those go first whose lane it joins does not stop for them but falls in behind one of them. With `d` to the
//! place where the ways meet it comes there after `t₀` if nothing holds it. Of the gaps between those in the lane that it joins, from the
//! first to the last, it takes the first in which it has, after `t ≥ t₀`,
//!
//! ```text
//! ahead   x_l + v_l t − l ≥ s₀ + T v          (to the rear of the leader of the gap)
//! behind  −(x_f + v_f t) − l ≥ s₀ + T v_f + (v_f − v)₊²/(2 b)
//! ```
//!
//! where `x` is how far a front is beyond the meeting, and `b` what the one behind may have to brake. Where no gap is long enough, it takes
//! the one that lacks least behind, of those that it reaches soon or without becoming slow ([`latest_s`]), and the one behind lets it in:
//! it slows down a little. Until it would not be too early it keeps its speed, or drives with `d/t` where that is less. So it slows down
//! early and a little, and joins with `v = v₀ + √(2 a (d − v₀ t))` if it keeps `v₀`.

use super::obliged::Obliged;
use crate::Agent;
use crate::road::network::{ConflictKind, Precedence, RouteConflict};
use crate::rules::giving_way::{LAG_BRAKING_MPS2, STANDSTILL_M, TIME_GAP_S, front_m, length_m, time_s};
use crate::scene::road_rules::Merging;

/// Ways that meet at a smaller angle than this run side by side before \[rad\].
const BESIDE_RAD: f64 = 0.2;
/// A vehicle beside its lane comes back if its direction is by more than this towards that \[rad\].
const BACK_RAD: f64 = 0.01;
/// A gap behind a vehicle slower than this is not waited for, of real vehicles \[m/s\].
const LEAST_MPS: f64 = 1.0;
/// Where there is an earlier gap, one is not waited for that takes more than this time longer than the way without others, of real
/// vehicles \[s\], and that on the way asks for less than this share of the speed of those in the lane that is joined.
const WAITED_S: f64 = 3.0;
const SLOWEST_SHARE: f64 = 0.5;
/// A vehicle becomes faster with this share of its strongest acceleration: cars with 1.2 m/s², about as drivers and the intelligent driver
/// model do at 20 m/s.
const GAINING_SHARE: f64 = 0.4;
/// Gaps are chosen this long before the ways meet, of real vehicles \[s\].
const EARLY_S: f64 = 20.0;

/// Whether a vehicle joins the way of others from the lane beside, and lets them go first.
pub(super) fn is_from_beside(ego: &Agent, other: &Agent, conflict: &RouteConflict) -> bool {
    let [own_rad, their_rad] = [(ego, conflict.own_m), (other, conflict.their_m)]
        .map(|(agent, [from_m, _])| agent.route.centre.at(from_m).heading_rad);
    conflict.kind == ConflictKind::Merging
        && conflict.precedence == Precedence::Other
        && libm::cos(own_rad - their_rad) > libm::cos(BESIDE_RAD)
        && ego.limits.comfort.is_some()
}

/// A vehicle on the way that is joined.
struct Passing<'a> {
    agent: &'a Agent,
    /// How far its front is beyond the meeting \[m\].
    beyond_m: f64,
    meeting_m: f64,
}

/// When and behind whom a vehicle merges; `None` where it joins no way from beside, and where it need not wait for anybody.
pub(super) fn merging(user: &Obliged<'_>, users: &[Obliged<'_>]) -> Option<Merging> {
    let Gap { ahead, in_s, free_s, meeting_m, .. } = best_gap(user, users)?;
    let ahead = ahead.filter(|_| in_s > free_s)?;
    Some(Merging { behind: ahead.name.clone(), meeting_m, in_s })
}

/// Which of some road users are asked to let one in that merges, because the gap before them is too short.
pub(super) fn let_in(users: &[Obliged<'_>]) -> Vec<bool> {
    let gaps = users.iter().filter(|user| user.is_judged()).filter_map(|user| best_gap(user, users));
    let asked: Vec<&str> =
        gaps.filter(|gap| gap.spare_m < 0.0).filter_map(|gap| gap.behind).map(|behind| behind.name.as_str()).collect();
    users.iter().map(|user| asked.contains(&user.agent.name.as_str())).collect()
}

/// The gap into which a vehicle merges.
struct Gap<'a> {
    ahead: Option<&'a Agent>,
    behind: Option<&'a Agent>,
    /// When it merges, and when it would without others \[s\].
    in_s: f64,
    free_s: f64,
    /// By how much there is more room behind than there has to be \[m\].
    spare_m: f64,
    /// Where the ways meet \[m\].
    meeting_m: f64,
}

fn best_gap<'a>(user: &Obliged<'_>, users: &[Obliged<'a>]) -> Option<Gap<'a>> {
    let ego = user.agent;
    let front_m = front_m(ego);
    let others = users.iter().map(|other| other.agent).filter(|other| other.name != ego.name);
    let mut passing: Vec<Passing<'_>> = others.filter_map(|other| passing(ego, other, front_m)).collect();
    passing.sort_by(|a, b| b.beyond_m.total_cmp(&a.beyond_m).then_with(|| a.agent.name.cmp(&b.agent.name)));
    let meeting_m = passing.iter().map(|other| other.meeting_m).reduce(f64::min)?;
    let way_m = meeting_m - front_m;
    let free_s = time_s(way_m, ego.state.speed_mps, user.wanted_mps, GAINING_SHARE * ego.limits.acceleration_max_mps2);
    if way_m <= 0.0 || free_s > EARLY_S * ego.body.real_ratio().sqrt() {
        return None;
    }
    let mut best: Option<Gap<'a>> = None;
    for gap in 0..=passing.len() {
        let ahead = gap.checked_sub(1).map(|ahead| &passing[ahead]);
        let Some(in_s) = earliest_s(ego, ahead, free_s, way_m) else { continue };
        if best.is_some() && in_s > latest_s(ego, ahead, free_s, way_m) {
            break;
        }
        let spare_m = spare_behind_m(ego, passing.get(gap), in_s, way_m);
        if best.as_ref().is_none_or(|best| spare_m > best.spare_m) {
            let [ahead, behind] = [ahead, passing.get(gap)].map(|other| other.map(|passing| passing.agent));
            best = Some(Gap { ahead, behind, in_s, free_s, spare_m, meeting_m });
        }
        if spare_m >= 0.0 {
            break;
        }
    }
    best
}

fn passing<'a>(ego: &Agent, other: &'a Agent, own_front_m: f64) -> Option<Passing<'a>> {
    let conflict = ego.route.conflicts_with(&other.route).find(|conflict| is_from_beside(ego, other, conflict))?;
    let is_ahead = own_front_m < conflict.own_m[0] && !ego.shares_lane_with(other);
    let beyond_m = front_m(other) - conflict.their_m[0];
    (is_ahead && is_in_its_lane(other)).then_some(Passing { agent: other, beyond_m, meeting_m: conflict.own_m[0] })
}

/// Whether any part of a vehicle is in the lane of its route, or it comes back there: it may have changed to the lane beside.
fn is_in_its_lane(other: &Agent) -> bool {
    let (at, half_m) = (other.place(), other.route.half_width.value(other.along_m()));
    let comes_back = libm::sin(other.state.heading_rad - at.heading_rad) * at.across_m < -BACK_RAD * at.across_m.abs();
    comes_back || at.across_m.abs() < half_m + 0.5 * other.body.width_m
}

/// The first time at which there is room behind a vehicle \[s\]; none behind one that hardly moves and is in the way.
fn earliest_s(ego: &Agent, ahead: Option<&Passing<'_>>, free_s: f64, way_m: f64) -> Option<f64> {
    let Some(Passing { agent, beyond_m, .. }) = ahead else { return Some(free_s) };
    let ratio = ego.body.real_ratio();
    let speed_mps = agent.state.speed_mps;
    let joining_mps = (way_m / free_s).max(speed_mps);
    let needed_m = STANDSTILL_M * ratio + TIME_GAP_S * ratio.sqrt() * joining_mps + length_m(agent) - beyond_m;
    if needed_m <= speed_mps * free_s {
        return Some(free_s);
    }
    (speed_mps > LEAST_MPS * ratio.sqrt()).then(|| needed_m / speed_mps)
}

/// Until when a gap behind a vehicle is waited for \[s\]: who becomes slow for its gap needs a longer one.
fn latest_s(ego: &Agent, ahead: Option<&Passing<'_>>, free_s: f64, way_m: f64) -> f64 {
    let slowest_mps = ahead.map_or(0.0, |ahead| SLOWEST_SHARE * ahead.agent.state.speed_mps);
    let at_slowest_s = if slowest_mps > 0.0 { way_m / slowest_mps } else { 0.0 };
    at_slowest_s.max(free_s + WAITED_S * ego.body.real_ratio().sqrt())
}

/// By how much the gap to the vehicle behind is longer than it has to be for one that joins in some time, so that it need not brake much
/// \[m\].
fn spare_behind_m(ego: &Agent, behind: Option<&Passing<'_>>, in_s: f64, way_m: f64) -> f64 {
    let Some(Passing { agent, beyond_m, .. }) = behind else { return f64::INFINITY };
    let ratio = ego.body.real_ratio();
    let speed_mps = agent.state.speed_mps;
    let (now_mps, gained_mps2) = (ego.state.speed_mps, GAINING_SHARE * ego.limits.acceleration_max_mps2);
    let kept_mps = now_mps.min(way_m / in_s);
    let joining_mps = kept_mps + (2.0 * gained_mps2 * (way_m - kept_mps * in_s)).max(0.0).sqrt();
    let slower_mps = (speed_mps - joining_mps).max(0.0);
    let needed_m = STANDSTILL_M * ratio
        + TIME_GAP_S * ratio.sqrt() * speed_mps
        + slower_mps * slower_mps / (2.0 * LAG_BRAKING_MPS2);
    -(beyond_m + speed_mps * in_s) - length_m(ego) - needed_m
}
