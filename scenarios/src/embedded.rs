//! The authored scenarios, embedded in the binary.

/// One authored scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Embedded {
    /// Its name: the path below `files`, without the extension.
    pub name: &'static str,
    /// The file as written.
    pub text: &'static str,
}

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(Embedded { name: $name, text: include_str!(concat!("../files/", $name, ".toml")) }),*]
    };
}

/// Sorted by name.
static FILES: &[Embedded] = files![
    "building/centralised-hundred",
    "building/concurrent-exact",
    "building/concurrent-uncertain",
    "building/distributed",
    "building/distributed-hundred",
    "building/distributed-nine",
    "building/distributed-rounds",
    "building/distributed-sixteen",
    "building/epw-weather",
    "building/fixed-free-nights",
    "building/fixed-warm-nights",
    "building/four-room-ilc",
    "building/four-room-pid",
    "building/hundred-zones",
    "building/iterative-free-nights",
    "building/iterative-model-error",
    "building/iterative-warm-nights",
    "building/pid-exact",
    "building/pid-uncertain",
    "building/tower",
    "crash/side-impact",
    "full-size/intersection",
    "full-size/lane-change",
    "full-size/lane-keeping",
    "full-size/ramp-merge",
    "intersection/four-way",
    "intersection/nice",
    "intersection/slanted-nice",
    "intersection/slanted-tough",
    "intersection/stop-sign",
    "intersection/tough",
    "lane-change/both-tough",
    "lane-change/front-nice",
    "lane-change/front-tough",
    "lane-keeping/nice",
    "lane-keeping/tough",
    "mixed/garage",
    "ramp-merge/nice",
    "ramp-merge/tough",
];

/// Every authored scenario, sorted by name.
pub fn embedded() -> &'static [Embedded] {
    FILES
}

/// The authored scenario of that name.
pub(crate) fn find(name: &str) -> Option<&'static Embedded> {
    FILES.iter().find(|file| file.name == name)
}
