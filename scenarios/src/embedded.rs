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
    "intersection/bayesian-inches",
    "intersection/bayesian-nice",
    "intersection/bayesian-tough",
    "intersection/conservative-nice",
    "intersection/cooperative",
    "intersection/four-way",
    "intersection/game-aggressive",
    "intersection/game-friendly",
    "intersection/game-nash",
    "intersection/negotiation-meets-game",
    "intersection/nice",
    "intersection/slanted-nice",
    "intersection/slanted-tough",
    "intersection/stop-sign",
    "intersection/tough",
    "lane-change/among-idm",
    "lane-change/bayesian-both-tough",
    "lane-change/bayesian-exact",
    "lane-change/bayesian-front-nice",
    "lane-change/bayesian-front-tough",
    "lane-change/bayesian-gap-closed",
    "lane-change/both-tough",
    "lane-change/conservative-front-nice",
    "lane-change/cooperative",
    "lane-change/front-nice",
    "lane-change/front-tough",
    "lane-change/game-aggressive",
    "lane-change/game-friendly",
    "lane-change/game-front-nice",
    "lane-change/game-nash",
    "lane-keeping/bayesian-nice",
    "lane-keeping/bayesian-tough",
    "lane-keeping/conservative-nice",
    "lane-keeping/cooperative",
    "lane-keeping/nice",
    "lane-keeping/tough",
    "lane-keeping/two-negotiators",
    "mixed/garage",
    "ramp-merge/bayesian-front-tough",
    "ramp-merge/bayesian-nice",
    "ramp-merge/bayesian-tough",
    "ramp-merge/conservative-nice",
    "ramp-merge/front-tough",
    "ramp-merge/game-nice",
    "ramp-merge/game-tough",
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
