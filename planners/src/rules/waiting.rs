//! Which vehicle waits for which, and how circles of waiting are broken.

/// One vehicle that another one has to wait for, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hold {
    /// The number of the other one.
    pub by: usize,
    /// Where it waits \[m\].
    pub line_m: f64,
}

/// Lets one vehicle of each circle go in which each waits for another one of the same circle and for no other: the first
/// one in the order of `turns`. None is let go before all of the circle have a turn.
pub(super) fn release(holds: &mut [Vec<Hold>], turns: &[Option<(usize, f64)>]) {
    let reaches = closure(holds);
    for vehicle in 0..holds.len() {
        let circle: Vec<usize> =
            (0..holds.len()).filter(|other| reaches[vehicle][*other] && reaches[*other][vehicle]).collect();
        let waits_within = |member: &usize| holds[*member].iter().all(|hold| circle.contains(&hold.by));
        let (true, Some(own)) = (circle.contains(&vehicle), turns[vehicle]) else { continue };
        let is_behind =
            |other: &usize| *other == vehicle || turns[*other].is_some_and(|their| own < their || !waits_within(other));
        if waits_within(&vehicle) && circle.iter().all(is_behind) {
            holds[vehicle].clear();
        }
    }
}

/// Whom each vehicle waits for, directly or through others.
fn closure(holds: &[Vec<Hold>]) -> Vec<Vec<bool>> {
    let count = holds.len();
    let mut reaches = vec![vec![false; count]; count];
    for (vehicle, held) in holds.iter().enumerate() {
        held.iter().for_each(|hold| reaches[vehicle][hold.by] = true);
    }
    for between in 0..count {
        for from in 0..count {
            if reaches[from][between] {
                for to in 0..count {
                    reaches[from][to] |= reaches[between][to];
                }
            }
        }
    }
    reaches
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waiting(pairs: &[(usize, usize)], count: usize) -> Vec<Vec<Hold>> {
        let mut holds = vec![Vec::new(); count];
        pairs.iter().for_each(|(who, by)| holds[*who].push(Hold { by: *by, line_m: 0.0 }));
        holds
    }

    /// The vehicles that go; those with smaller numbers came first.
    fn released(pairs: &[(usize, usize)], count: usize) -> Vec<usize> {
        let mut holds = waiting(pairs, count);
        let before = holds.clone();
        release(&mut holds, &(0..count).map(|tick| Some((tick, 0.0))).collect::<Vec<_>>());
        (0..count).filter(|vehicle| holds[*vehicle] != before[*vehicle]).collect()
    }

    #[test]
    fn the_first_of_a_circle_goes_and_chains_stay() {
        assert_eq!(released(&[(0, 1), (1, 2)], 3), Vec::<usize>::new(), "a chain is not a circle");
        assert_eq!(released(&[(2, 0), (0, 1), (1, 2)], 3), [0]);
        assert_eq!(released(&[(0, 1), (1, 0), (2, 0)], 3), [0], "who waits for a circle is not in it");
        assert_eq!(released(&[(0, 1), (1, 0), (0, 2)], 3), [1], "the first waits for a third one, too");
        assert_eq!(released(&[(0, 1), (1, 0), (2, 3), (3, 2)], 4), [0, 2], "one of each circle");
    }

    #[test]
    fn no_vehicle_goes_before_all_have_arrived() {
        let mut holds = waiting(&[(0, 1), (1, 0)], 2);
        release(&mut holds, &[Some((0, 0.0)), None]);
        assert_eq!(holds, waiting(&[(0, 1), (1, 0)], 2));
    }
}
