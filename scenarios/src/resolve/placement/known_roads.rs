//! Results about roads, kept for other scenarios on the same road: networks, routes through them, and where these meet.
//!
//! Each result is a function of its key alone, so a kept result equals a new one.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

use interplay_planners::Route;
use interplay_planners::road::network::{LaneUser, RoadNetwork};

/// The most kept entries of each kind. A plan that varies its road has more; the later ones are computed each time.
const MAX_ENTRIES: usize = 256;

/// Networks by the text of their road.
#[derive(Default)]
pub(crate) struct KnownRoads(Memo<String, KnownNetwork>);

/// A network, and results about it.
pub(super) struct KnownNetwork {
    /// The network.
    pub network: Arc<RoadNetwork>,
    /// The parts of it that are open to a type of road user, if some lanes are restricted.
    open: Memo<String, RoadNetwork>,
    /// Routes by the words that decide them.
    routes: Memo<Vec<String>, Route>,
    /// Routes that store where they meet, by the lanes of each.
    sets: Memo<Vec<Vec<String>>, Vec<Arc<Route>>>,
}

impl KnownRoads {
    /// The network of a road; `None` for parallel lanes.
    ///
    /// # Errors
    /// Those of `compute`, which makes it.
    pub(super) fn network<E>(
        &self,
        road: String,
        compute: impl FnOnce() -> Result<Option<RoadNetwork>, E>,
    ) -> Result<Option<Arc<KnownNetwork>>, E> {
        let network = || -> Result<KnownNetwork, Option<E>> {
            let network = Arc::new(compute()?.ok_or(None)?);
            Ok(KnownNetwork { network, open: Memo::default(), routes: Memo::default(), sets: Memo::default() })
        };
        self.0.get(road, network).map_or_else(|error| error.map_or(Ok(None), Err), |known| Ok(Some(known)))
    }
}

impl KnownNetwork {
    /// The part of the network that is open to a road user.
    pub fn open_to(&self, user: LaneUser) -> Arc<RoadNetwork> {
        if !self.network.has_restricted_lanes() {
            return Arc::clone(&self.network);
        }
        let open = self.open.get(format!("{user:?}"), || Ok::<_, ()>(self.network.open_to(user)));
        open.unwrap_or_else(|()| Arc::clone(&self.network))
    }

    /// The route that some words determine.
    ///
    /// # Errors
    /// Those of `compute`, which makes it.
    pub fn route<E>(&self, words: Vec<String>, compute: impl FnOnce() -> Result<Route, E>) -> Result<Arc<Route>, E> {
        self.routes.get(words, compute)
    }

    /// These routes, such that they store where they meet.
    pub fn set_of(&self, routes: Vec<Arc<Route>>) -> Vec<Arc<Route>> {
        if self.network.has_restricted_lanes() {
            return Route::set_of(routes.into_iter().map(Arc::unwrap_or_clone).collect());
        }
        let words = |route: &Arc<Route>| {
            // Drivers leave lanes that end at different places.
            let lanes = route.legs.iter().map(|leg| format!("{} to {:?}", leg.lane, leg.to_m));
            // Bodies that swing out have lines of their own along the same lanes.
            lanes.chain(route.is_swept().then(|| format!("{:?}", route.end_m()))).collect::<Vec<String>>()
        };
        let key = routes.iter().map(words).collect();
        let compute = || Ok::<_, ()>(Route::set_of(routes.into_iter().map(Arc::unwrap_or_clone).collect()));
        self.sets.get(key, compute).map(|set| Vec::clone(&set)).unwrap_or_default()
    }
}

struct Memo<K, V>(Mutex<HashMap<K, Arc<V>>>);

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Memo(Mutex::new(HashMap::new()))
    }
}

impl<K: Eq + Hash, V> Memo<K, V> {
    /// The value of a key, computed if it is unknown. Several threads may compute it at the same time.
    fn get<E>(&self, key: K, compute: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = known().get(&key) {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(compute()?);
        let mut all = known();
        if all.len() < MAX_ENTRIES {
            all.insert(key, Arc::clone(&value));
        }
        Ok(value)
    }
}
