//! A house of two zones, as the network and as the resources of an FMU.

use std::fs;
use std::path::{Path, PathBuf};
use std::process;

use interplay_building::discretise::Model;
use interplay_building::network::{Network, Wall, Zone};

/// The GUID of the FMU.
pub const GUID: &str = "{0-0}";
/// Time from one step to the next \[s\].
pub const STEP_S: f64 = 1800.0;

/// Two zones and a wall that stores heat and gets sun.
pub fn model() -> Model {
    let zones = [Zone::named("office"), Zone::named("store")];
    let walls = [
        Wall { solar_aperture_m2: 1.0, ..Wall::new("office", "store", 40.0).with_capacity_kj_per_k(900.0) },
        Wall::new("office", "ambient", 30.0),
        Wall::new("store", "ambient", 60.0),
    ];
    Model::exact(&Network::new(&zones, &walls).expect("a network"), 1800.0).expect("a model")
}

/// Outdoor temperature of a step \[°C\].
pub fn ambient_c(step: usize) -> f64 {
    10.0 + 5.0 * (step as f64).sin()
}

/// Heat of people and sun in both zones and the wall in a step \[kW\].
pub fn gains_kw(step: usize) -> [f64; 3] {
    [0.1 * (step % 5) as f64, 0.03, 0.2 * (step % 3) as f64]
}

fn line<T: ToString>(word: &str, numbers: impl IntoIterator<Item = T>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(|number| number.to_string()).collect();
    format!("{word} {}\n", numbers.join(" "))
}

/// The resources of `steps` steps.
pub fn resources(model: &Model, steps: usize) -> String {
    let nodes = model.network().node_count();
    let flat = |matrix: by_columns::Rows| matrix.into_iter().flatten().collect::<Vec<f64>>();
    [
        format!("interplay-plant 1\nguid {GUID}\nstep_s 1800\nnodes {nodes}\nzones 2\ngained 3\nsteps {steps}\n"),
        line("initial_c", vec![20.0; nodes]),
        line("state", flat(by_columns::rows(nodes, nodes, |unit| model.state_product(unit)))),
        line("gain", flat(by_columns::rows(nodes, 3, |unit| model.gain_product(unit)))),
        line("outdoor", model.gain_product(model.network().ambient_kw_per_k())),
        line("ambient_c", (0..steps).map(ambient_c)),
        line("gains_kw", (0..steps).flat_map(gains_kw)),
    ]
    .concat()
}

/// Matrices as lists of rows, found by products with unit vectors.
mod by_columns {
    pub type Rows = Vec<Vec<f64>>;

    /// The rows of the matrix whose products with unit vectors of `nodes` entries are given.
    pub fn rows(nodes: usize, count: usize, product: impl Fn(&[f64]) -> Vec<f64>) -> Rows {
        let mut rows = vec![vec![0.0; count]; nodes];
        for column in 0..count {
            let mut unit = vec![0.0; nodes];
            unit[column] = 1.0;
            for (row, value) in rows.iter_mut().zip(product(&unit)) {
                row[column] = value;
            }
        }
        rows
    }
}

/// A folder of resources that is removed when it is dropped.
pub struct Resources(PathBuf);

impl Resources {
    pub fn write(test: &str, content: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("interplay fmu {test} {}", process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join("plant.txt"), content).expect("a file");
        Self(folder)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Resources {
    fn drop(&mut self) {
        // A folder that stays behind among the temporary files does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}
