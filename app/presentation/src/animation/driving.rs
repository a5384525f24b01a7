//! Pictures of vehicles: the road with all vehicles, and a bar of words below.

use interplay_planners::{Body, State};

use super::camera::{CameraView, WIDTH_PX, car_m, views};
use super::canvas::{Align, Canvas, Ink, LineEnd};
use super::caption::{
    BAR, Caption, MARGIN_PX, TEXT_PX, TITLE_PX, WORDS, caption, contacts, draw_edge_mark, draw_title,
};
use super::legend::{self, LegendRow};
use super::letters::{cut, width_of};
use super::pictures::{Pictures, Rgb};
use super::scene::{DrivingRun, SeenVehicle};
use super::timing::{PICTURE_S, PictureTime, moments};
use super::{ribbon, road, vehicle};
use crate::edge_mark::edge_marks;
use crate::figures::RecordedRun;
use crate::palette::{ASPHALT, BRAKE_LIGHT, Colour, FLASH, GRASS, INDICATOR, OTHERS, VERMILLION};
use crate::passing_words::{contact_place, star};
use crate::rectangle::{Rectangle, overlap, rectangle_around};
use crate::road_shapes::RoadShapes;

const QUIET_WORDS: Colour = [0xB4, 0xB8, 0xBE];
const ALARM: Colour = [0xFF, 0x6B, 0x5B];
/// A plan that ends within this distance of the vehicle, in lengths of the vehicle, is not drawn: that of a standing or creeping
/// vehicle is a knot.
const MIN_RIBBON_RATIO: f64 = 1.5;
/// Height of a line of words below the view \[px\].
const LINE_PX: f64 = 22.0;
/// Size of small words \[px\].
const LABEL_PX: f64 = legend::TEXT_PX;
/// Rows of the legend of a crowd, which lists the coloured vehicles.
const CROWD_LEGEND_ROWS: usize = 3;
/// Width of the line of an alternative continuation of a plan \[px\].
const BRANCH_PX: f64 = 2.5;

/// Pictures of a run with vehicles.
pub struct DrivingPictures<'a> {
    run: DrivingRun<'a>,
    moments: Vec<PictureTime>,
    views: Vec<CameraView>,
    road: RoadShapes,
    /// Rows of the legend; empty for a crowd, whose legend changes from picture to picture.
    legend: Vec<LegendRow>,
    /// Explanation of the marks on the road.
    key: String,
}

impl<'a> DrivingPictures<'a> {
    /// The pictures of a run; `None` without vehicles.
    pub fn from_run(recorded: &'a RecordedRun) -> Option<DrivingPictures<'a>> {
        let run = DrivingRun::from_run(recorded)?;
        let moments = moments(&recorded.report, &run.times());
        let views = views(&run, &moments);
        let bounds = views.iter().map(CameraView::bounds_m).reduce(|[a, b], [c, d]| {
            [[0, 1].map(|axis| a[axis].min(c[axis])), [0, 1].map(|axis| b[axis].max(d[axis]))]
        })?;
        let road = RoadShapes::trace(run.scenario, bounds);
        let driven: Vec<usize> = run.driven().collect();
        let legend = match driven.len() {
            _ if run.scenario.is_flow_alone() => legend::of_flows(run.scenario, &driven),
            count if count > OTHERS.len() + 1 => Vec::new(),
            _ => legend::of_vehicles(run.scenario, &driven),
        };
        let key = key(&run, &moments);
        Some(DrivingPictures { run, moments, views, road, legend, key })
    }

    fn bar_px(&self) -> f64 {
        let rows = if self.legend.is_empty() { CROWD_LEGEND_ROWS } else { self.legend.len() };
        LINE_PX * (2.0 + rows as f64) + 14.0
    }

    fn draw_view(
        &self,
        canvas: &mut Canvas,
        view: &CameraView,
        seen: &[SeenVehicle],
        time_s: f64,
        mentioned: &[usize],
    ) {
        road::draw(&self.road, canvas, view);
        road::draw_lights(&self.road, canvas, view, time_s);
        let lane_px = self.run.scenario.road.lane_width_m() * view.px_per_m;
        for (vehicle, seen) in self.run.scenario.vehicles.iter().zip(seen).filter(|(_, seen)| !seen.is_absent) {
            if is_ribbon(&seen.plan, &vehicle.body) && seen.is_named {
                let plan: Vec<[f64; 2]> = seen.plan.iter().map(|point| view.place(*point)).collect();
                let width = (0.55 * vehicle.body.width_m * view.px_per_m).min(0.3 * lane_px);
                ribbon::draw(canvas, &plan, width, seen.plan_colour);
            }
        }
        for seen in seen.iter().filter(|seen| seen.is_named) {
            for branch in &seen.branches {
                let line: Vec<[f64; 2]> = branch.iter().map(|point| view.place(*point)).collect();
                canvas.line(&line, BRANCH_PX, LineEnd::Round, Ink::translucent(seen.colour, 1.0));
            }
            let dots = seen.proposals.iter().flat_map(|proposal| {
                let places: Vec<[f64; 2]> = proposal.iter().map(|point| view.place(*point)).collect();
                spaced(&places, 11.0)
            });
            for dot in dots {
                canvas.disc(dot, 3.6, [0xFF, 0xFF, 0xFF]);
                canvas.disc(dot, 2.6, seen.colour);
            }
        }
        let vehicles = || self.run.scenario.vehicles.iter().zip(seen);
        vehicles().for_each(|(vehicle, seen)| vehicle::draw_shadow(canvas, view, vehicle, seen));
        vehicles().for_each(|(vehicle, seen)| vehicle::draw(canvas, view, vehicle, seen));
        self.draw_contacts(canvas, view, seen, time_s);
        let taken = self.draw_edge_marks(canvas, view, seen, mentioned);
        self.draw_names(canvas, view, (seen, mentioned), taken);
    }

    /// Draws a star where two vehicles touch, for a while after the contact began.
    fn draw_contacts(&self, canvas: &mut Canvas, view: &CameraView, seen: &[SeenVehicle], time_s: f64) {
        let car_px = car_m(self.run.scenario) * view.px_per_m;
        for between in contacts(&self.run, time_s) {
            let states = between.map(|index| &seen[index].state);
            let Some(place) = contact_place(self.run.scenario, between, states).map(|place| view.place(place)) else {
                continue;
            };
            canvas.fill(&star(place, 0.28 * car_px), VERMILLION.rgb);
            canvas.fill(&star(place, 0.18 * car_px), FLASH);
        }
    }

    /// Draws marks at the edge for mentioned vehicles out of view. Returns the rectangles of all vehicles and then of the words.
    fn draw_edge_marks(
        &self,
        canvas: &mut Canvas,
        view: &CameraView,
        seen: &[SeenVehicle],
        mentioned: &[usize],
    ) -> Vec<Rectangle> {
        let states: Vec<State> = seen.iter().map(|seen| seen.state).collect();
        let mut taken: Vec<Rectangle> = (0..seen.len()).map(|index| self.bounds_px(view, seen, index)).collect();
        for mark in edge_marks(self.run.scenario, view, &states, mentioned) {
            let words = draw_edge_mark(canvas, view, &mark, seen[mark.vehicle].colour, &taken);
            taken.push(words);
        }
        taken
    }

    /// Left, top, right and bottom of a vehicle \[px\].
    fn bounds_px(&self, view: &CameraView, seen: &[SeenVehicle], vehicle: usize) -> Rectangle {
        let corners = self.run.scenario.vehicles[vehicle].body.corners(&seen[vehicle].state);
        rectangle_around(corners.map(|corner| view.place(corner)))
    }

    /// Draws names beside the vehicles, clear of the rectangles in `taken`, the first of which are those of the vehicles. In a crowd
    /// only coloured and mentioned vehicles have names.
    fn draw_names(
        &self,
        canvas: &mut Canvas,
        view: &CameraView,
        (seen, mentioned): (&[SeenVehicle], &[usize]),
        mut taken: Vec<Rectangle>,
    ) {
        for (index, vehicle) in self.run.scenario.vehicles.iter().enumerate() {
            let is_unnamed = !seen[index].is_named && !mentioned.contains(&index);
            if vehicle.obstacle.is_some() || seen[index].is_absent || is_unnamed {
                continue;
            }
            let [left, top, right, bottom] = taken[index];
            let (wide, high) = (width_of(&vehicle.name, LABEL_PX) + 10.0, LABEL_PX + 4.0);
            let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
            let middles = [
                [x, top - 0.5 * high - 4.0],
                [x, bottom + 0.5 * high + 5.0],
                [right + 0.5 * wide + 4.0, y],
                [left - 0.5 * wide - 4.0, y],
            ];
            let label = |[x, y]: [f64; 2]| [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high];
            let is_seen = right > 0.0 && left < WIDTH_PX && bottom > 0.0 && top < view.size_px[1];
            let is_free = |middle: &&[f64; 2]| {
                let [l, t, r, b] = label(**middle);
                let inside = l >= 2.0 && t >= 2.0 && r <= WIDTH_PX - 2.0 && b <= view.size_px[1] - 2.0;
                inside && !taken.iter().any(|other| overlap([l, t, r, b], *other))
            };
            let Some(middle) = middles.iter().find(is_free).filter(|_| is_seen) else { continue };
            let place = label(*middle);
            taken.push(place);
            let [l, t, r, b] = place;
            canvas.fill_rounded(&[[l, t], [r, t], [r, b], [l, b]], 5.0, Ink::translucent(BAR, 0.82));
            canvas.text(*middle, Align::Middle, LABEL_PX, &vehicle.name, WORDS);
        }
    }

    fn draw_title(&self, canvas: &mut Canvas, moment: &PictureTime) {
        let clock = format!("{:.1} s", moment.time_s);
        let speed = match moment.rate {
            1.0 => String::new(),
            rate if rate < 1.0 => format!("slow motion 1/{:.0}", 1.0 / rate),
            rate => format!("{rate}× speed"),
        };
        let clock_left = WIDTH_PX - MARGIN_PX - 66.0;
        let longest = clock_left - 2.0 * MARGIN_PX - width_of("slow motion 1/4", LABEL_PX);
        draw_title(canvas, &self.run.scenario.title, longest, &clock);
        let ink = if moment.rate < 1.0 { ALARM } else { QUIET_WORDS };
        canvas.text([clock_left, 0.5 * TITLE_PX], Align::Right, LABEL_PX, &speed, ink);
    }

    /// The legend of the vehicles of a crowd that have a colour now.
    fn crowd_legend(&self, seen: &[SeenVehicle]) -> Vec<LegendRow> {
        // Entries are in the order of the colours, so that each keeps its position while others change.
        let place = |index: &usize| OTHERS.iter().position(|colour| colour.rgb == seen[*index].colour);
        let mut listed: Vec<usize> = self.run.driven().filter(|index| seen[*index].is_named).collect();
        listed.sort_by_key(place);
        let mut rows = legend::of_vehicles(self.run.scenario, &listed);
        rows.truncate(CROWD_LEGEND_ROWS);
        rows
    }

    fn draw_words(&self, canvas: &mut Canvas, top: f64, words: &Caption, seen: &[SeenVehicle]) {
        let [width, height] = canvas.size();
        canvas.block([0.0, top], [width, height], BAR);
        let line = |row: f64| top + 7.0 + (row + 0.5) * LINE_PX;
        let longest = WIDTH_PX - 2.0 * MARGIN_PX;
        let ink = if words.alarms { ALARM } else { WORDS };
        canvas.text([MARGIN_PX, line(0.0)], Align::Left, TEXT_PX, &cut(&words.first, TEXT_PX, longest), ink);
        let longest = longest - width_of(&self.key, LABEL_PX) - 2.0 * MARGIN_PX;
        canvas.text([MARGIN_PX, line(1.0)], Align::Left, LABEL_PX, &cut(&words.second, LABEL_PX, longest), QUIET_WORDS);
        canvas.text([WIDTH_PX - MARGIN_PX, line(1.0)], Align::Right, LABEL_PX, &self.key, QUIET_WORDS);
        let near = if self.legend.is_empty() { self.crowd_legend(seen) } else { Vec::new() };
        for (row, entries) in self.legend.iter().chain(&near).enumerate() {
            let y = line(2.0 + row as f64);
            for (index, words, left) in entries {
                let ring = [[*left, y - 5.5], [left + 17.0, y - 5.5], [left + 17.0, y + 5.5], [*left, y + 5.5]];
                canvas.fill_rounded(&ring, 4.0, seen[*index].colour);
                let speed = match &seen[*index] {
                    seen if seen.is_absent || !seen.is_named => words.clone(),
                    seen => format!("{words} {:.1} m/s", seen.state.speed_mps.abs()),
                };
                canvas.text([left + 23.0, y], Align::Left, LABEL_PX, &speed, WORDS);
            }
        }
    }
}

impl Pictures for DrivingPictures<'_> {
    fn count(&self) -> usize {
        self.moments.len()
    }

    fn size(&self) -> [u32; 2] {
        let height = TITLE_PX + self.views[0].size_px[1] + self.bar_px();
        [WIDTH_PX as u32, (2.0 * (0.5 * height).ceil()) as u32]
    }

    fn draw(&self, index: usize) -> Option<Rgb> {
        let (moment, view) = (&self.moments[index], &self.views[index]);
        let seen = self.run.seen(moment.time_s, index as f64 * PICTURE_S);
        let mut ground = Canvas::new([WIDTH_PX as u32, view.size_px[1] as u32], GRASS)?;
        let words = caption(&self.run, moment.time_s);
        let mut mentioned = self.run.partners(moment.time_s);
        mentioned.retain(|index| seen[*index].is_named);
        mentioned.extend(
            words
                .mentioned(self.run.scenario)
                .into_iter()
                .filter(|index| !mentioned.contains(index))
                .collect::<Vec<_>>(),
        );
        self.draw_view(&mut ground, view, &seen, moment.time_s, &mentioned);
        let mut canvas = Canvas::new(self.size(), BAR)?;
        canvas.put(&ground, TITLE_PX as u32);
        self.draw_title(&mut canvas, moment);
        self.draw_words(&mut canvas, TITLE_PX + view.size_px[1], &words, &seen);
        Some(canvas.into_rgb())
    }

    fn exact_colours(&self) -> Vec<Colour> {
        // Without this, the colours of small or rare areas would be merged with similar ones.
        let plan = |colour: &Colour| ribbon::ink(*colour).over(ASPHALT);
        let rare = [BRAKE_LIGHT, INDICATOR, vehicle::brake_glow().over(ASPHALT), BAR, WORDS, ALARM];
        let colours = self.run.used_colours();
        colours.iter().copied().chain(rare).chain(colours.iter().map(plan)).collect()
    }
}

/// The explanation of the marks that occur in an animation.
fn key(run: &DrivingRun, moments: &[PictureTime]) -> String {
    let seen: Vec<SeenVehicle> = moments.iter().flat_map(|moment| run.seen(moment.time_s, 0.0)).collect();
    let is_ribbon = |(index, seen): (usize, &SeenVehicle)| {
        seen.is_named && is_ribbon(&seen.plan, &run.scenario.vehicles[index % run.scenario.vehicles.len()].body)
    };
    [
        (seen.iter().enumerate().any(is_ribbon), "band: plan"),
        (seen.iter().any(|seen| !seen.branches.is_empty()), "lines: alternative continuations"),
        (seen.iter().any(|seen| !seen.proposals.is_empty()), "dots: motion it requests or expects of another"),
    ]
    .into_iter()
    .filter(|(is_drawn, _)| *is_drawn)
    .map(|(_, words)| words)
    .collect::<Vec<_>>()
    .join("   ")
}

/// Whether a plan is long enough to be drawn.
fn is_ribbon(plan: &[[f64; 2]], body: &Body) -> bool {
    let Some([x, y]) = plan.first() else { return false };
    let least_m = MIN_RIBBON_RATIO * (body.front_m + body.rear_m);
    plan.iter().any(|point| libm::hypot(point[0] - x, point[1] - y) > least_m)
}

/// Points at equal distances along a line.
fn spaced(points: &[[f64; 2]], distance: f64) -> Vec<[f64; 2]> {
    let (mut found, mut left) = (Vec::new(), 0.0);
    for pair in points.windows(2) {
        let [dx, dy] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = libm::hypot(dx, dy);
        while left < length {
            found.push([pair[0][0] + dx * left / length, pair[0][1] + dy * left / length]);
            left += distance;
        }
        left -= length;
    }
    found
}

#[cfg(test)]
impl DrivingPictures<'_> {
    /// The centres of the vehicles in a picture \[px\], with their colours.
    pub fn roofs(&self, index: usize) -> Vec<([f64; 2], Colour)> {
        let seen = self.run.seen(self.moments[index].time_s, 0.0);
        let place = |(vehicle, seen): (&interplay_scenarios::Vehicle, &SeenVehicle)| {
            let corners = vehicle.body.corners(&seen.state).map(|corner| self.views[index].place(corner));
            [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0)
        };
        let places = self.run.scenario.vehicles.iter().zip(&seen).map(place);
        let inside = |[x, _]: &[f64; 2]| (0.0..WIDTH_PX).contains(x);
        places
            .zip(seen.iter().map(|seen| seen.colour))
            .filter(|(place, _)| inside(place))
            .map(|([x, y], colour)| ([x, y + TITLE_PX], colour))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// Only marks that are drawn are explained: a game has no proposals, a negotiation has dots.
    #[test]
    fn the_key_explains_the_marks_that_are_drawn() {
        let key = |name: &str| {
            let recorded =
                RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
            DrivingPictures::from_run(&recorded).expect("vehicles").key
        };
        assert_eq!(key("roundabout/nice"), "band: plan");
        assert_eq!(key("intersection/nice"), "band: plan   dots: motion it requests or expects of another");
        assert_eq!(key("ramp-merge/contingency"), "band: plan   lines: alternative continuations");
    }

    #[test]
    fn the_plan_of_a_standing_vehicle_is_not_drawn() {
        let body = Body::default();
        let length_m = body.front_m + body.rear_m;
        let knot: Vec<[f64; 2]> = [0.0, 0.4, 0.8].map(|share| [share * length_m, 0.2 * share * length_m]).to_vec();
        assert!(!is_ribbon(&knot, &body) && !is_ribbon(&[], &body));
        assert!(is_ribbon(&[[0.0, 0.0], [2.0 * length_m, 0.0]], &body));
    }
}
