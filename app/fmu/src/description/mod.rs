//! `modelDescription.xml`, the description of the variables, in either version of FMI.

mod fmi2;
mod fmi3;

use interplay_building::network::PowerLimits;

/// The description of a unit in a version of FMI.
pub(crate) fn xml(unit: &Description<'_>, version: FmiVersion) -> String {
    match version {
        FmiVersion::Two => fmi2::xml(unit),
        FmiVersion::Three => fmi3::xml(unit),
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Description<'a> {
    pub title: &'a str,
    /// The name of the library.
    pub identifier: &'a str,
    /// The GUID, which the resources repeat.
    pub guid: &'a str,
    pub zones: &'a [String],
    /// The power limits of each zone.
    pub limits: &'a PowerLimits,
    /// Time from one step to the next \[s\].
    pub step_s: f64,
    /// End of the weather \[s\].
    pub stop_s: f64,
}

struct Variable {
    pub name: String,
    pub description: String,
    /// Heat, which is zero until it is set; all others are outputs.
    pub is_input: bool,
    pub unit: &'static str,
}

impl Description<'_> {
    /// The description of the unit in words.
    fn summary(&self) -> String {
        let step_s = self.step_s;
        format!(
            "A thermal network with its weather. Heat is held between steps; steps are whole multiples of {step_s} s."
        )
    }

    /// The variables in the order of their value references (`library/instance.rs`).
    fn variables(&self) -> Vec<Variable> {
        let PowerLimits { heating_kw, cooling_kw } = self.limits;
        let heat = |(index, zone): (usize, &String)| Variable {
            name: format!("{zone}.heat"),
            description: format!(
                "Heat of the equipment of {zone}, at most {} kW; negative when it cools, at most {} kW",
                heating_kw[index], cooling_kw[index]
            ),
            is_input: true,
            unit: "kW",
        };
        let temperature = |zone: &String| Variable {
            name: format!("{zone}.temperature"),
            description: format!("Temperature of {zone}"),
            is_input: false,
            unit: "degC",
        };
        let gains = |zone: &String| Variable {
            name: format!("{zone}.gains"),
            description: format!("Heat of people, machines and sun in {zone}, until the next step"),
            is_input: false,
            unit: "kW",
        };
        let outdoor = Variable {
            name: "outdoor temperature".to_owned(),
            description: "Temperature outdoors, until the next step".to_owned(),
            is_input: false,
            unit: "degC",
        };
        let heats = self.zones.iter().enumerate().map(heat);
        let temperatures = self.zones.iter().map(temperature);
        heats.chain(temperatures).chain(self.zones.iter().map(gains)).chain([outdoor]).collect()
    }
}

/// A text within an attribute. Characters that XML does not allow are replaced by question marks.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\u{FFFE}' | '\u{FFFF}' => safe.push('?'),
            _ if character.is_control() => safe.push('?'),
            _ => safe.push(character),
        }
    }
    safe
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    #[default]
    Two,
    /// FMI 3.0.
    Three,
}

impl FmiVersion {
    /// The folder of binaries and their extension for a system, by the names of [`std::env::consts`]. For some systems FMI 2.0 defines
    /// no folder; these have the names that tools agree on.
    pub(crate) fn binary(self, system: &str, processor: &str) -> Option<(&'static str, &'static str)> {
        let (two, three, extension) = match (system, processor) {
            ("linux", "x86_64") => ("linux64", "x86_64-linux", "so"),
            ("linux", "aarch64") => ("aarch64-linux", "aarch64-linux", "so"),
            ("windows", "x86_64") => ("win64", "x86_64-windows", "dll"),
            ("macos", "x86_64") => ("darwin64", "x86_64-darwin", "dylib"),
            ("macos", "aarch64") => ("aarch64-darwin", "aarch64-darwin", "dylib"),
            _ => return None,
        };
        Some((if self == Self::Two { two } else { three }, extension))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_names_in_an_fmu_depend_on_the_fmi_version() {
        let folders = |system, processor| {
            [FmiVersion::Two, FmiVersion::Three]
                .map(|version| version.binary(system, processor).map(|(folder, _)| folder))
        };
        assert_eq!(folders("linux", "x86_64"), [Some("linux64"), Some("x86_64-linux")]);
        assert_eq!(folders("windows", "x86_64"), [Some("win64"), Some("x86_64-windows")]);
        assert_eq!(FmiVersion::Three.binary("windows", "x86_64"), Some(("x86_64-windows", "dll")));
        assert_eq!(folders("linux", "riscv64"), [None, None]);
    }
}
