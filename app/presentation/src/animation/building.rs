//! Pictures of a building: the floor plan as a heat map over the day, beside it the outdoor temperature and that of the rooms.

use interplay_simulation::frame::{BuildingFrame, Frame};

use super::camera::WIDTH_PX;
use super::canvas::{Align, Canvas, Ink, LineEnd};
use super::caption::{BAR, TITLE_PX, WORDS, draw_title};
use super::chart::Chart;
use super::pictures::{Pictures, Rgb};
use super::rooms::Rooms;
use crate::figures::RecordedRun;
use crate::palette::{
    BLUE, COLOUR_RANGE_K, Colour, GREEN, ORANGE, deviation_colour, middle_c, one_decimal, temperature_colour,
    usual_wanted_c, zone_colour,
};

const PAPER: Colour = [0xF7, 0xF7, 0xF4];
const DARK_WORDS: Colour = [0x2A, 0x2C, 0x30];
const GREY: Colour = [0x8A, 0x8D, 0x92];
const HEIGHT_PX: f64 = 440.0;
const SMALL_PX: f64 = 13.0;
/// Left, top, right and bottom of the floor plan, of the chart outdoors and of that of the rooms \[px\].
const PLAN_PX: [f64; 4] = [14.0, 44.0, 384.0, 394.0];
const OUTDOORS_PX: [f64; 4] = [440.0, 66.0, 704.0, 216.0];
const INDOORS_PX: [f64; 4] = [440.0, 260.0, 704.0, 404.0];
/// The same with a chart of the price between the two.
const OUTDOORS_ABOVE_PX: [f64; 4] = [440.0, 62.0, 704.0, 146.0];
const PRICE_PX: [f64; 4] = [440.0, 190.0, 704.0, 260.0];
const INDOORS_BELOW_PX: [f64; 4] = [440.0, 304.0, 704.0, 404.0];
/// Number of pictures of a day.
const PICTURES_PER_DAY: usize = 32;
/// Of a longer run only the first and the last day are shown.
const MAX_SHOWN_DAYS: usize = 2;
const HOURS: f64 = 24.0;

/// Pictures of a run with a building.
pub struct BuildingPictures<'a> {
    title: &'a str,
    rooms: Rooms,
    /// The steps of every shown day, with the number of the day from 1.
    days: Vec<(usize, Vec<&'a BuildingFrame>)>,
    day_count: usize,
    /// The usual wanted temperature of each zone, the middle of the colour scale while none is wanted \[°C\].
    usual_c: Vec<f64>,
    /// Least and greatest temperature outdoors and in the rooms \[°C\].
    outdoors_c: [f64; 2],
    indoors_c: [f64; 2],
    /// Least and greatest price of electricity and its unit, if there is a price.
    price: Option<([f64; 2], String)>,
}

impl<'a> BuildingPictures<'a> {
    /// The pictures of a run; `None` without a building.
    pub fn from_run(recorded: &'a RecordedRun) -> Option<BuildingPictures<'a>> {
        let scenario = &recorded.scenario;
        let building = scenario.building.as_ref()?;
        let network = building.network().ok()?;
        let names = network.names()[..network.zone_count()].to_vec();
        let steps: Vec<&BuildingFrame> = recorded.frames.iter().filter_map(of_building).collect();
        let day_count = steps.last()?.day + 1;
        let shown: Vec<usize> =
            if day_count <= MAX_SHOWN_DAYS { (0..day_count).collect() } else { vec![0, day_count - 1] };
        let of_day = |day: usize| (day + 1, steps.iter().copied().filter(|step| step.day == day).collect());
        let days: Vec<(usize, Vec<&BuildingFrame>)> = shown.into_iter().map(of_day).collect();
        let seen = || days.iter().flat_map(|(_, steps)| steps);
        let zones = || seen().flat_map(|step| &step.zones);
        let wanted_c = zones().filter_map(|zone| zone.reference_c);
        Some(BuildingPictures {
            title: &scenario.title,
            usual_c: usual_wanted_c(scenario, &names),
            rooms: Rooms::new(building.floor_plan(), names, PLAN_PX),
            outdoors_c: range(seen().flat_map(|step| [step.ambient_c, step.forecast_c])),
            indoors_c: range(zones().map(|zone| zone.temperature_c).chain(wanted_c)),
            price: price(recorded, seen().filter_map(|step| step.price_per_kwh)),
            days,
            day_count,
        })
    }

    /// The index of the shown day and the hour of a picture.
    fn time(&self, index: usize) -> (usize, f64) {
        let day = (index / PICTURES_PER_DAY).min(self.days.len() - 1);
        (day, HOURS * (index - day * PICTURES_PER_DAY) as f64 / PICTURES_PER_DAY as f64)
    }

    fn draw_plan(&self, canvas: &mut Canvas, step: &BuildingFrame, share: f64) {
        let [left, top, right, bottom] = PLAN_PX;
        let outdoors = deviation_colour(step.ambient_c - middle_c(&self.usual_c));
        let ring = [[left, top], [right, top], [right, bottom], [left, bottom]];
        canvas.fill_rounded(&ring, 10.0, Ink::translucent(outdoors, 0.45));
        let inside = |zone: usize| {
            let zone = &step.zones[zone];
            zone.temperature_c + share * (zone.next_c - zone.temperature_c)
        };
        for room in 0..step.zones.len() {
            let temperature_c = inside(room);
            let colour = zone_colour(&step.zones[room], temperature_c, self.usual_c[room]);
            self.rooms.draw(canvas, room, colour, temperature_c, step.zones[room].heat_kw);
        }
        self.rooms.draw_floor_names(canvas, DARK_WORDS);
        let words = format!("outdoors {} °C", one_decimal(step.ambient_c));
        canvas.text([0.5 * (left + right), bottom - 11.0], Align::Middle, SMALL_PX, &words, DARK_WORDS);
        self.draw_scale(canvas);
    }

    /// The colours of temperatures.
    fn draw_scale(&self, canvas: &mut Canvas) {
        let (left, top, wide) = (PLAN_PX[0] + 70.0, 404.0, 230.0);
        for part in 0..46 {
            let share = -1.0 + 2.0 * (f64::from(part) + 0.5) / 46.0;
            let x = left + wide * f64::from(part) / 46.0;
            canvas.block([x, top], [x + wide / 46.0, top + 14.0], temperature_colour(share));
        }
        let y = top + 7.0;
        canvas.text([left - 8.0, y], Align::Right, SMALL_PX, &format!("−{COLOUR_RANGE_K:.0} K"), DARK_WORDS);
        canvas.text([left + wide + 8.0, y], Align::Left, SMALL_PX, &format!("+{COLOUR_RANGE_K:.0} K"), DARK_WORDS);
        let words = "from the wanted temperature; while none is wanted, from its mean";
        canvas.text([left + 0.5 * wide, top + 24.0], Align::Middle, SMALL_PX, words, DARK_WORDS);
    }

    fn draw_outdoors(&self, canvas: &mut Canvas, steps: &[&BuildingFrame], hour: f64) {
        let place = if self.price.is_some() { OUTDOORS_ABOVE_PX } else { OUTDOORS_PX };
        let chart = Chart { place, across: [0.0, HOURS], up: self.outdoors_c };
        chart.draw_axes(canvas, "Outdoors [°C]");
        let points = |value: fn(&BuildingFrame) -> f64| -> Vec<[f64; 2]> {
            steps.iter().map(|step| [hour_of(steps, step.step), value(step)]).collect()
        };
        chart.dashed(canvas, &points(|step| step.forecast_c), 1.6, GREY);
        chart.draw_past(canvas, &points(|step| step.ambient_c), hour, BLUE.rgb);
        chart.draw_cursor(canvas, hour);
    }

    /// Draws the price, which is known for the whole day and constant during a step.
    fn draw_price(&self, canvas: &mut Canvas, steps: &[&BuildingFrame], hour: f64) {
        let Some((range, unit)) = &self.price else { return };
        let chart = Chart { place: PRICE_PX, across: [0.0, HOURS], up: *range };
        chart.draw_axes(canvas, &format!("Price of electricity [{unit}]"));
        let held = |step: &&BuildingFrame| {
            let price = step.price_per_kwh.unwrap_or_default();
            [step.step, step.step + 1].map(|at| [hour_of(steps, at), price])
        };
        let points: Vec<[f64; 2]> = steps.iter().flat_map(held).collect();
        chart.dashed(canvas, &points, 1.6, GREY);
        chart.draw_past(canvas, &points, hour, GREEN.rgb);
        chart.draw_cursor(canvas, hour);
    }

    fn draw_indoors(&self, canvas: &mut Canvas, steps: &[&BuildingFrame], hour: f64) {
        let place = if self.price.is_some() { INDOORS_BELOW_PX } else { INDOORS_PX };
        let chart = Chart { place, across: [0.0, HOURS], up: self.indoors_c };
        chart.draw_axes(canvas, "Rooms, coldest to warmest [°C]");
        let past = |step: &&&BuildingFrame| hour_of(steps, step.step) <= hour + 1e-9;
        let bounds: Vec<(f64, [f64; 2])> = steps
            .iter()
            .filter(past)
            .map(|step| (hour_of(steps, step.step), range(step.zones.iter().map(|zone| zone.temperature_c))))
            .collect();
        let upper = bounds.iter().map(|(hour, [_, high])| [*hour, *high]);
        let lower = bounds.iter().rev().map(|(hour, [low, _])| [*hour, *low]);
        let ring: Vec<[f64; 2]> = upper.chain(lower).map(|point| chart.pixel(point)).collect();
        if ring.len() > 2 {
            canvas.fill(&ring, Ink::translucent(ORANGE.rgb, 0.35));
        }
        let mean = |step: &BuildingFrame| {
            step.zones.iter().map(|zone| zone.temperature_c).sum::<f64>() / step.zones.len().max(1) as f64
        };
        let means: Vec<[f64; 2]> = steps.iter().map(|step| [hour_of(steps, step.step), mean(step)]).collect();
        let wanted = |step: &BuildingFrame| range(step.zones.iter().filter_map(|zone| zone.reference_c));
        let is_wanted = |step: &BuildingFrame| step.zones.iter().any(|zone| zone.reference_c.is_some());
        for run in steps.chunk_by(|a, b| is_wanted(a) == is_wanted(b)).filter(|run| is_wanted(run[0])) {
            for end in 0..2 {
                let line: Vec<[f64; 2]> =
                    run.iter().map(|step| [hour_of(steps, step.step), wanted(step)[end]]).collect();
                chart.dashed(canvas, &line, 1.6, DARK_WORDS);
            }
        }
        chart.draw_past(canvas, &means, hour, ORANGE.rgb);
        chart.draw_cursor(canvas, hour);
    }
}

impl Pictures for BuildingPictures<'_> {
    fn count(&self) -> usize {
        self.days.len() * PICTURES_PER_DAY
    }

    fn size(&self) -> [u32; 2] {
        [WIDTH_PX as u32, HEIGHT_PX as u32]
    }

    fn draw(&self, index: usize) -> Option<Rgb> {
        let (day, hour) = self.time(index);
        let (number, steps) = &self.days[day];
        let at = hour / HOURS * steps.len() as f64;
        let step = steps.get(at as usize).or(steps.last())?;
        let mut canvas = Canvas::new(self.size(), PAPER)?;
        let clock = format!(
            "day {number} of {}   {:02}:{:02}",
            self.day_count,
            hour as u32,
            (hour.fract() * 60.0).round() as u32
        );
        draw_title(&mut canvas, self.title, 490.0, &clock);
        self.draw_plan(&mut canvas, step, at.fract());
        self.draw_outdoors(&mut canvas, steps, hour);
        self.draw_price(&mut canvas, steps, hour);
        self.draw_indoors(&mut canvas, steps, hour);
        let key = match self.price {
            Some(_) => "solid: so far   dashed: to come; lowest and highest wanted",
            None => "solid: so far   dashed: forecast; lowest and highest wanted",
        };
        canvas.text([INDOORS_PX[2], HEIGHT_PX - 10.0], Align::Right, SMALL_PX, key, DARK_WORDS);
        canvas.line(&[[0.0, TITLE_PX], [WIDTH_PX, TITLE_PX]], 1.0, LineEnd::Flat, BAR);
        Some(canvas.into_rgb())
    }

    fn exact_colours(&self) -> Vec<Colour> {
        vec![PAPER, BAR, WORDS, DARK_WORDS, BLUE.rgb, GREEN.rgb, ORANGE.rgb]
    }
}

fn of_building(frame: &Frame) -> Option<&BuildingFrame> {
    frame.building.as_ref()
}

/// Least and greatest price and their unit; `None` without prices.
fn price(recorded: &RecordedRun, prices: impl Iterator<Item = f64>) -> Option<([f64; 2], String)> {
    let prices: Vec<f64> = prices.collect();
    let currency = recorded.report.building.as_ref()?.currency.as_deref()?;
    (!prices.is_empty()).then(|| (range(prices.into_iter()), format!("{currency}/kWh")))
}

/// The hour at which a step of a day begins.
fn hour_of(steps: &[&BuildingFrame], step: usize) -> f64 {
    HOURS * step as f64 / steps.len().max(1) as f64
}

/// Least and greatest value.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

#[cfg(test)]
mod tests {
    use interplay_scenarios::load;

    use super::*;

    /// At noon of the last day every room has the colour of its temperature in the middle of its upper third.
    #[test]
    fn rooms_have_the_colours_of_their_temperatures() {
        let name = "building/four-room-pid";
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let pictures = BuildingPictures::from_run(&recorded).expect("a building");
        let last = pictures.count() - PICTURES_PER_DAY / 2;
        let pixels = pictures.draw(last).expect("a picture");
        let (day, hour) = pictures.time(last);
        let steps = &pictures.days[day].1;
        let at = hour / HOURS * steps.len() as f64;
        let step = steps[at as usize];
        for (index, zone) in step.zones.iter().enumerate() {
            let [left, top, right, _] = pictures.rooms.place(index);
            let (x, y) = ((0.5 * (left + right)) as usize, (top + 8.0) as usize);
            let found = [0, 1, 2].map(|part| pixels[3 * (WIDTH_PX as usize * y + x) + part]);
            let now_c = zone.temperature_c + at.fract() * (zone.next_c - zone.temperature_c);
            let expected = zone_colour(zone, now_c, pictures.usual_c[index]);
            assert_eq!(found, expected, "room {index}");
        }
        assert_eq!(pixels.len(), 3 * 720 * 440);
    }

    #[test]
    fn a_run_without_a_building_has_no_floor_plan() {
        let name = "lane-change/front-nice";
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        assert!(BuildingPictures::from_run(&recorded).is_none());
    }

    /// The colour shows the deviation from the wanted temperature, so rooms are not all blue in winter.
    #[test]
    fn a_room_near_its_wanted_temperature_is_grey_in_winter() {
        let name = "building/office-and-flat";
        let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
        let pictures = BuildingPictures::from_run(&recorded).expect("a building");
        let zones = pictures.days.iter().flat_map(|(_, steps)| steps).flat_map(|step| step.zones.iter().enumerate());
        let colours: Vec<Colour> =
            zones.map(|(index, zone)| zone_colour(zone, zone.temperature_c, pictures.usual_c[index])).collect();
        let coldest = colours.iter().filter(|colour| **colour == temperature_colour(-1.0)).count();
        assert!(3 * coldest < colours.len(), "{coldest} of {}", colours.len());
    }
}
