//! The part of a plan's runs that a process makes.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::key::RunKey;

/// A part of all runs: number `index`, from 1, of `count`. The keys assign the runs, so shards have similar sizes and every run is in
/// exactly one, in whichever order the plan numbers its runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub index: u32,
    /// Number of shards.
    pub count: u32,
}

/// Why a shard is invalid.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ShardError {
    /// The text is not a shard.
    #[error("`{0}` is not a shard; write for example `3/8`, the third of eight")]
    Form(String),
    /// The number is beyond the count.
    #[error("there is no shard {index} of {count}: shards have the numbers 1 to {count}")]
    Beyond {
        /// The number.
        index: u64,
        /// Number of shards.
        count: u32,
    },
    /// A variable of the scheduler does not contain a number.
    #[error("the variable {variable} is `{value}`, which is not a whole number")]
    Variable {
        /// Its name.
        variable: &'static str,
        /// Its value.
        value: String,
    },
    /// No variable states which shard this is.
    #[error(
        "with `--shards`, the scheduler says which shard this is; none of SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX and \
         HQ_TASK_ID is set. To choose it, write `--shard I/N`"
    )]
    Unknown,
}

impl Shard {
    /// The shard that contains all runs.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// The shard number `index`, from 1, of `count`.
    ///
    /// # Errors
    /// [`ShardError::Beyond`].
    pub fn new(index: u64, count: u32) -> Result<Shard, ShardError> {
        match u32::try_from(index) {
            Ok(index) if (1..=count).contains(&index) => Ok(Shard { index, count }),
            _ => Err(ShardError::Beyond { index, count }),
        }
    }

    /// The shard of a scheduler's task, from its environment variables as `variable` returns them: of a Slurm array, whose size
    /// is known, or with a `count` of any of Slurm, Kubernetes and HyperQueue. `None` if this is not a task of an array.
    ///
    /// Slurm counts its tasks from `SLURM_ARRAY_TASK_MIN`, Kubernetes from 0; tasks of HyperQueue must be numbered from 1.
    ///
    /// # Errors
    /// If a variable is not a number or exceeds the count, or if there is a count but no such variable.
    pub fn of_scheduler(
        count: Option<u32>,
        variable: impl Fn(&'static str) -> Option<String>,
    ) -> Result<Option<Shard>, ShardError> {
        let number = |name: &'static str| -> Result<Option<u64>, ShardError> {
            let Some(value) = variable(name).filter(|value| !value.is_empty()) else { return Ok(None) };
            value.parse().map(Some).map_err(|_| ShardError::Variable { variable: name, value })
        };
        let tasks = number("SLURM_ARRAY_TASK_COUNT")?.and_then(|tasks| u32::try_from(tasks).ok());
        if let (Some(task), Some(count)) = (number("SLURM_ARRAY_TASK_ID")?, count.or(tasks)) {
            let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(1);
            return Shard::new((task + 1).saturating_sub(first), count).map(Some);
        }
        let Some(count) = count else { return Ok(None) };
        if let Some(index) = number("JOB_COMPLETION_INDEX")? {
            return Shard::new(index.saturating_add(1), count).map(Some);
        }
        match number("HQ_TASK_ID")? {
            Some(task) => Shard::new(task, count).map(Some),
            None => Err(ShardError::Unknown),
        }
    }

    /// Whether a run belongs to this shard.
    pub fn holds(self, key: RunKey) -> bool {
        key.number() % u128::from(self.count) == u128::from(self.index - 1)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Shard, ShardError> {
        let parts = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        let (index, count) = parts.ok_or_else(|| ShardError::Form(text.to_owned()))?;
        Shard::new(index, count)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(count: Option<u32>, variables: &[(&str, &str)]) -> Result<Option<Shard>, ShardError> {
        let value = |name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned());
        Shard::of_scheduler(count, value)
    }

    #[test]
    fn every_run_is_in_one_shard_and_shards_have_similar_sizes() {
        let keys: Vec<RunKey> = (0..8000).map(|run| RunKey::of_parts(&[&run.to_string()])).collect();
        let sizes: Vec<usize> = (1..=8)
            .map(|index| Shard { index, count: 8 })
            .map(|shard| keys.iter().filter(|key| shard.holds(**key)).count())
            .collect();
        assert_eq!(sizes.iter().sum::<usize>(), 8000);
        // Five standard deviations of a binomial count of 8000 with a share of an eighth.
        assert!(sizes.iter().all(|size| size.abs_diff(1000) < 150), "{sizes:?}");
    }

    #[test]
    fn the_shard_is_read_from_the_variables_of_schedulers() {
        let third = Ok(Some(Shard { index: 3, count: 8 }));
        let slurm = [("SLURM_ARRAY_TASK_ID", "3"), ("SLURM_ARRAY_TASK_COUNT", "8"), ("SLURM_ARRAY_TASK_MIN", "1")];
        assert_eq!(of(None, &slurm), third);
        let from_zero = [("SLURM_ARRAY_TASK_ID", "2"), ("SLURM_ARRAY_TASK_COUNT", "8"), ("SLURM_ARRAY_TASK_MIN", "0")];
        assert_eq!(of(None, &from_zero), third);
        assert_eq!(of(Some(8), &[("JOB_COMPLETION_INDEX", "2")]), third);
        assert_eq!(of(Some(8), &[("HQ_TASK_ID", "3")]), third);
        assert_eq!(of(None, &[("HQ_TASK_ID", "3")]), Ok(None), "every task of HyperQueue has a number");
        assert_eq!(of(None, &[]), Ok(None));
    }

    #[test]
    fn an_invalid_shard_is_refused() {
        assert_eq!(of(Some(8), &[]), Err(ShardError::Unknown));
        assert_eq!(of(Some(8), &[("JOB_COMPLETION_INDEX", "8")]), Err(ShardError::Beyond { index: 9, count: 8 }));
        assert!(matches!(of(Some(8), &[("HQ_TASK_ID", "x")]), Err(ShardError::Variable { .. })));
        for text in ["", "3", "0/8", "9/8", "1/0", "a/b", "-1/8", "1/8/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
        assert_eq!("3/8".parse(), Ok(Shard { index: 3, count: 8 }));
    }
}
