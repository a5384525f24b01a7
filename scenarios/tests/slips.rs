//! Slips of an author, and whether the message names what was meant and the line that is to blame.

use interplay_scenarios::{Fault, Override, from_text};

fn faults(text: &str, sets: &[&str]) -> Vec<Fault> {
    let sets: Vec<Override> = sets.iter().map(|set| Override::Set((*set).to_owned())).collect();
    from_text("my.toml", text, &sets).expect_err("the file is spoilt").faults().to_vec()
}

fn only(text: &str, sets: &[&str]) -> Fault {
    let faults = faults(text, sets);
    assert_eq!(faults.len(), 1, "{faults:?}");
    faults[0].clone()
}

fn hint(fault: &Fault) -> &str {
    fault.hint().unwrap_or_default()
}

const VARIANT: &str = "extends = \"lane-change/front-nice\"\ntitle = \"a\"\nshows = \"b\"\n";

#[test]
fn a_misspelt_vehicle_of_a_variant_is_told_its_nearest_name() {
    let text = format!("{VARIANT}[[vehicle]]\nname = \"fornt\"\ndriver = {{ kind = \"human\", style = \"tough\" }}\n");
    let fault = only(&text, &[]);
    assert_eq!(fault.message(), "`vehicle.fornt.start` is missing");
    assert!(hint(&fault).starts_with("did you mean `front`?"), "{}", hint(&fault));
    assert_eq!((fault.file(), fault.line_and_column()), (Some("my.toml"), Some((5, 8))));
    let stranger = only(&text.replace("fornt", "lorry"), &[]);
    assert!(!hint(&stranger).contains("did you mean"), "{}", hint(&stranger));
}

#[test]
fn a_vehicle_of_a_variant_that_stands_there_twice_is_told_so() {
    let entry = "[[vehicle]]\nname = \"front\"\ndriver = { kind = \"human\", style = \"tough\" }\n";
    let fault = only(&format!("{VARIANT}{entry}{entry}"), &[]);
    assert_eq!(fault.message(), "`vehicle.front` stands there twice");
    assert_eq!(hint(&fault), "join them, or give one of them another name");
    assert_eq!((fault.file(), fault.line_and_column()), (Some("my.toml"), Some((8, 8))));
}

#[test]
fn a_word_in_capitals_is_told_its_own_spelling() {
    let fault = only(&format!("{VARIANT}[[vehicle]]\nname = \"front\"\ndriver = {{ kind = \"IDM\" }}\n"), &[]);
    assert_eq!(hint(&fault), "did you mean `idm`?");
    let by_flag = only(VARIANT, &["vehicle.front.driver.style=\"TOUGH\""]);
    assert_eq!(hint(&by_flag), "did you mean `tough`?");
}

#[test]
fn an_overlap_is_blamed_on_what_moved_a_vehicle() {
    // The ego comes first in the file that is extended, so that the overlap is found at the other's start.
    let moved = format!("{VARIANT}[[vehicle]]\nname = \"ego\"\nstart = {{ x_m = 0.0, y_m = 0.555 }}\n");
    let all = faults(&moved, &[]);
    assert!(all.iter().all(|fault| fault.message().contains("overlap at the start")), "{all:?}");
    let places: Vec<_> =
        all.iter().map(|fault| (fault.file(), fault.line_and_column().map(|(line, _)| line))).collect();
    assert!(places.iter().all(|place| *place == (Some("my.toml"), Some(6))), "{places:?}");
    for set in ["vehicle.rear.start.x_m=0.1", "vehicle.front.body.width_m=0.37"] {
        let text = VARIANT.replace("front-nice", "front-tough");
        let Err(error) = from_text("my.toml", &text, &[Override::Set(set.to_owned())]) else { continue };
        assert!(error.faults().iter().all(|fault| fault.file() == Some("--set")), "{error:?}");
    }
}

#[test]
fn scaled_numbers_are_short_in_messages() {
    let text = "title = \"a\"\nshows = \"b\"\nscale = 3.0\nvehicle = [{ name = \"ego\", \
                start = { x_m = 0.0, y_m = 0.5, speed_mps = 99.0 } }]\n";
    let said: String = faults(text, &[]).iter().map(|fault| format!("{} {}\n", fault.message(), hint(fault))).collect();
    assert!(said.contains("outside the vehicle's limits"), "{said}");
    let digits = |word: &str| word.chars().filter(char::is_ascii_digit).count();
    assert!(said.split_whitespace().all(|word| digits(word) <= 6), "{said}");
}

/// One bracket where a list wants two: at the header with one, whichever comes first.
#[test]
fn one_bracket_instead_of_two_is_told_so() {
    for (vehicles, line, message) in [
        ("[vehicle]\nname = 'a'\n[vehicle]\nname = 'b'\n", 5, "`[vehicle]` stands here for the second time"),
        ("[vehicle]\nname = 'a'\n[[vehicle]]\nname = 'b'\n", 3, "`[vehicle]` stands here beside `[[vehicle]]`"),
        ("[[vehicle]]\nname = 'a'\n[vehicle]\nname = 'b'\n", 5, "`[vehicle]` stands here beside `[[vehicle]]`"),
    ] {
        let fault = only(&format!("title = 'a'\nshows = 'b'\n{vehicles}"), &[]);
        assert_eq!((fault.message(), fault.line_and_column()), (message, Some((line, 1))));
        assert_eq!(hint(&fault), "of each one of several, write `[[vehicle]]`");
    }
}
