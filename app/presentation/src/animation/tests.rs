//! The content of encoded files, checked by decoders.

use std::io::Cursor;

use interplay_scenarios::load;

use super::building::BuildingPictures;
use super::driving::DrivingPictures;
use super::pictures::Pictures;
use super::{AnimationFormat, encoded};
use crate::figures::RecordedRun;
use crate::palette::{ASPHALT, BLUE, Colour, ORANGE};

fn recorded(name: &str) -> RecordedRun {
    let mut scenario = load(name, &[]).expect("embedded");
    scenario.duration_s = 2.0;
    RecordedRun::record(name, scenario, Vec::new(), "").expect("a run")
}

/// How many pixels of a picture have a colour.
fn count(rgb: &[u8], colour: Colour) -> usize {
    rgb.as_chunks::<3>().0.iter().filter(|pixel| **pixel == colour).count()
}

/// Every picture of a GIF as a decoder shows it, red, green, blue.
fn decoded_gif(bytes: &[u8]) -> ([usize; 2], Vec<Vec<u8>>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(Cursor::new(bytes)).expect("a GIF");
    let [width, height] = [decoder.width(), decoder.height()].map(usize::from);
    let mut shown = vec![0; 3 * width * height];
    let mut pictures = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        for (index, pixel) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = (index % usize::from(frame.width), index / usize::from(frame.width));
            let at = 3 * ((usize::from(frame.top) + y) * width + usize::from(frame.left) + x);
            if pixel[3] > 0 {
                shown[at..at + 3].copy_from_slice(&pixel[..3]);
            }
        }
        pictures.push(shown.clone());
    }
    ([width, height], pictures)
}

#[test]
fn a_gif_shows_every_picture_in_its_colours() {
    let recorded = recorded("lane-change/front-nice");
    let pictures = DrivingPictures::from_run(&recorded).expect("vehicles");
    let bytes = encoded(&recorded, AnimationFormat::Gif).expect("a GIF");
    let (size, shown) = decoded_gif(&bytes);
    assert_eq!(size, pictures.size().map(|part| part as usize));
    assert_eq!(shown.len(), pictures.count());
    assert!(shown.len() >= 20, "{}", shown.len());
    for (index, shown) in shown.iter().enumerate() {
        let drawn = pictures.draw(index).expect("a picture");
        for colour in [ORANGE.rgb, BLUE.rgb] {
            assert!(count(&drawn, colour) > 200, "picture {index}");
            assert!(count(shown, colour) >= count(&drawn, colour), "picture {index}: exact colours stay");
        }
        let off: usize = drawn.iter().zip(shown).map(|(a, b)| usize::from(a.abs_diff(*b))).sum();
        assert!((off as f64) < 2.0 * drawn.len() as f64, "picture {index}: {off}");
    }
}

#[test]
fn a_webp_shows_the_same_as_a_gif() {
    let recorded = recorded("intersection/nice");
    let (size, gif) = decoded_gif(&encoded(&recorded, AnimationFormat::Gif).expect("a GIF"));
    let bytes = encoded(&recorded, AnimationFormat::WebP).expect("a WebP");
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&bytes)).expect("a WebP");
    assert!(decoder.is_animated());
    let (width, height) = decoder.dimensions();
    assert_eq!([width as usize, height as usize], size);
    assert_eq!(decoder.num_frames() as usize, gif.len());
    let mut pixels = vec![0; decoder.output_buffer_size().expect("a size")];
    for (index, expected) in gif.iter().enumerate() {
        decoder.read_frame(&mut pixels).expect("a frame");
        let rgb: Vec<u8> = pixels.as_chunks::<4>().0.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        // The decoder blends opaque pixels, too, and is off by up to 3 in that.
        let off = rgb.iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(3), "picture {index}: {off:?}");
    }
}

#[test]
fn a_filmstrip_has_eight_pictures() {
    let recorded = recorded("intersection/nice");
    let bytes = encoded(&recorded, AnimationFormat::Filmstrip).expect("a PNG");
    let [width, height] = DrivingPictures::from_run(&recorded).expect("vehicles").size();
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("a picture");
    assert_eq!([info.width, info.height], [2 * width + 6, 4 * height + 3 * 6]);
    assert!(count(&pixels, ORANGE.rgb) > 8 * 200);
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    for name in ["crash/side-impact", "building/four-room-pid"] {
        let bytes = || encoded(&recorded(name), AnimationFormat::Gif).expect("a GIF");
        assert!(bytes() == bytes(), "{name}");
    }
}

/// The scenario with the most changes from picture to picture: the camera follows around a ring.
#[test]
fn twelve_seconds_are_at_most_three_megabytes() {
    let name = "roundabout/nice";
    let recorded = RecordedRun::record(name, load(name, &[]).expect("embedded"), Vec::new(), "").expect("a run");
    let pictures = DrivingPictures::from_run(&recorded).expect("vehicles");
    let bytes = encoded(&recorded, AnimationFormat::Gif).expect("a GIF").len() as f64;
    let shown_s = pictures.count() as f64 * super::timing::PICTURE_S;
    assert!(shown_s > 5.0 && bytes / shown_s * 12.0 < 3e6, "{bytes} bytes for {shown_s} s");
}

/// The roof of a vehicle has its colour at its place, in every picture where it is not covered.
#[test]
fn vehicles_are_drawn_at_their_positions() {
    let recorded = recorded("lane-change/front-nice");
    let pictures = DrivingPictures::from_run(&recorded).expect("vehicles");
    for index in 0..pictures.count() {
        let drawn = pictures.draw(index).expect("a picture");
        let width = pictures.size()[0] as usize;
        for (place, colour) in pictures.roofs(index) {
            let [x, y] = place.map(|part| part as usize);
            let found = [0, 1, 2].map(|part| drawn[3 * (y * width + x) + part]);
            assert_eq!(found, colour, "picture {index} at {x}, {y}");
        }
    }
}

/// A run with vehicles and a building shows both: the road first, the rooms at the end.
#[test]
fn a_run_with_a_building_beside_the_road_shows_both() {
    let recorded = recorded("mixed/garage");
    let road = DrivingPictures::from_run(&recorded).expect("vehicles");
    let rooms = BuildingPictures::from_run(&recorded).expect("a building");
    let (_, shown) = decoded_gif(&encoded(&recorded, AnimationFormat::Gif).expect("a GIF"));
    assert_eq!(shown.len(), road.count() + rooms.count());
    assert!(count(&shown[0], BLUE.rgb) > 200 && count(&shown[0], ASPHALT) > 1000);
    assert!(count(&shown[shown.len() - 1], ASPHALT) < 100);
}
