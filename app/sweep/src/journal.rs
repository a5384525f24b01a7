//! The journals of a folder: one line for each run, appended when the run is done.
//!
//! A line is written at once, so a killed process leaves at most one torn line, the last. A torn line has no end; it is ignored,
//! and cut off before the next append. A line that does not match its checksum counts as missing and is reported.
//! All other lines of a journal stay permanently, including rows of other plans and versions.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::SweepError;
use crate::journal_line::{JournalLine, judged, line_of};
use crate::key::{RunKey, program_version};
use crate::row::SweepRow;
use crate::shard::Shard;

/// Prefix and extension of the names of journals.
const PREFIX: &str = "journal";
const SUFFIX: &str = ".jsonl";
/// Interval between syncs to the disk. A killed process loses nothing either way; a machine that loses
/// power loses at most the runs of this interval. All threads wait during a sync, for tens of milliseconds on a busy disk.
const SYNC_INTERVAL: Duration = Duration::from_secs(10);

/// The journal of a shard in a folder.
pub(crate) fn path_of(folder: &Path, shard: Shard) -> PathBuf {
    folder.join(match shard {
        Shard::WHOLE => format!("{PREFIX}{SUFFIX}"),
        Shard { index, count } => format!("{PREFIX}-{index}-of-{count}{SUFFIX}"),
    })
}

/// All journals of a folder, sorted by name.
pub(crate) fn journals(folder: &Path) -> Result<Vec<PathBuf>, SweepError> {
    let failed = SweepError::file("read", folder);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(&failed)? {
        let path = entry.map_err(&failed)?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name.starts_with(PREFIX) && name.ends_with(SUFFIX) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// A journal to which rows are appended. It is locked for one process.
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    synced: Instant,
}

impl Journal {
    /// Opens a journal, creates it if it does not exist, and cuts off a torn last line.
    pub fn open(path: &Path) -> Result<Journal, SweepError> {
        let failed = SweepError::file("open", path);
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path).map_err(&failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(SweepError::InUse(path.to_owned())),
            // On file systems without locks, users must prevent concurrent writers.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let whole = length_of_whole_lines(&mut file).map_err(&failed)?;
        if whole < file.metadata().map_err(&failed)?.len() {
            file.set_len(whole).map_err(&failed)?;
        }
        Ok(Journal { path: path.to_owned(), file, synced: Instant::now() })
    }

    pub fn append(&mut self, row: &SweepRow) -> Result<(), SweepError> {
        let failed = |reason: io::Error| SweepError::file("write to", &self.path)(reason);
        let line = line_of(&serde_json::to_string(row).map_err(|reason| failed(reason.into()))?);
        self.file.write_all(line.as_bytes()).map_err(failed)?;
        if self.synced.elapsed() >= SYNC_INTERVAL {
            self.file.sync_data().map_err(failed)?;
            self.synced = Instant::now();
        }
        Ok(())
    }

    /// Syncs all lines to the disk.
    pub fn sync(&self) -> Result<(), SweepError> {
        self.file.sync_data().map_err(SweepError::file("write to", &self.path))
    }
}

/// Length of the file without a torn last line \[bytes\].
fn length_of_whole_lines(file: &mut File) -> io::Result<u64> {
    const BLOCK: u64 = 64 * 1024;
    let mut end = file.metadata()?.len();
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        let mut block = vec![0; (end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(&mut block)?;
        if let Some(at) = block.iter().rposition(|byte| *byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

/// All rows of a journal, including those that older versions wrote without a checksum; a torn last line is ignored.
///
/// # Errors
/// If a line is damaged or is not a row, since these runs cannot be repeated.
pub(crate) fn read_rows(path: &Path) -> Result<Vec<SweepRow>, SweepError> {
    let text = fs::read_to_string(path).map_err(SweepError::file("read", path))?;
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let lines = whole.lines().enumerate().filter(|(_, line)| !line.is_empty());
    let row = |(index, line): (usize, &str)| match judged(line.as_bytes()) {
        JournalLine::Damaged => Err(SweepError::Damaged { path: path.to_owned(), line: index + 1 }),
        JournalLine::Sound | JournalLine::Unchecked => parsed(path, index + 1, line.as_bytes()),
    };
    lines.map(row).collect()
}

/// Parses a line of a journal.
fn parsed<T: DeserializeOwned>(path: &Path, line: usize, text: &[u8]) -> Result<T, SweepError> {
    serde_json::from_slice(text).map_err(|reason| SweepError::Journal { path: path.to_owned(), line, reason })
}

/// The location of a run's line.
#[derive(Clone, Copy, Debug)]
struct LinePlace {
    journal: u32,
    line: u32,
    start: u64,
    length: u32,
}

/// The location of each run's line in a folder; of several lines of one run, the first.
pub(crate) struct JournalIndex {
    journals: Vec<PathBuf>,
    places: HashMap<RunKey, LinePlace>,
    /// Lines that are damaged or not rows: journal and line, from 1.
    damaged: Vec<(PathBuf, usize)>,
}

/// The field of a line that identifies its run.
#[derive(Deserialize)]
struct Keyed {
    key: RunKey,
    version: String,
}

/// The run to which a line belongs.
enum LineRun {
    Known(RunKey),
    /// A row that an older version wrote without a checksum; no plan needs it any more.
    Older,
    Damaged,
}

impl LineRun {
    fn of(line: &[u8]) -> LineRun {
        let keyed: Option<Keyed> = serde_json::from_slice(line).ok();
        match (judged(line), keyed) {
            (JournalLine::Sound, Some(keyed)) => LineRun::Known(keyed.key),
            (JournalLine::Unchecked, Some(keyed)) if keyed.version != program_version() => LineRun::Older,
            _ => LineRun::Damaged,
        }
    }
}

impl JournalIndex {
    pub fn empty() -> JournalIndex {
        JournalIndex { journals: Vec::new(), places: HashMap::new(), damaged: Vec::new() }
    }

    /// Reads all journals of a folder. It takes about 60 bytes for each run.
    pub fn read(folder: &Path) -> Result<JournalIndex, SweepError> {
        let mut index = JournalIndex { journals: journals(folder)?, places: HashMap::new(), damaged: Vec::new() };
        for journal in 0..index.journals.len() {
            index.read_journal(journal)?;
        }
        Ok(index)
    }

    fn read_journal(&mut self, journal: usize) -> Result<(), SweepError> {
        let path = self.journals[journal].clone();
        let failed = SweepError::file("read", &path);
        let mut reader = BufReader::new(File::open(&path).map_err(&failed)?);
        let (mut start, mut line, mut text) = (0, 1, Vec::new());
        loop {
            text.clear();
            let length = reader.read_until(b'\n', &mut text).map_err(&failed)?;
            if text.last() != Some(&b'\n') {
                // This is the end, a torn line, or a line that is being written.
                return Ok(());
            }
            if text.len() > 1 {
                match LineRun::of(&text) {
                    LineRun::Known(key) => {
                        let place =
                            LinePlace { journal: journal as u32, line: line as u32, start, length: length as u32 };
                        self.places.entry(key).or_insert(place);
                    }
                    LineRun::Older => {}
                    LineRun::Damaged => self.damaged.push((path.clone(), line)),
                }
            }
            start += length as u64;
            line += 1;
        }
    }

    /// Lines that are damaged or not rows: journal and line, from 1. Their runs count as missing.
    pub fn damaged(&self) -> &[(PathBuf, usize)] {
        &self.damaged
    }

    /// Whether the journals contain a run.
    pub fn holds(&self, key: RunKey) -> bool {
        self.places.contains_key(&key)
    }

    /// Reads the existing rows of the given keys, in this order, each with the value beside its key.
    pub fn rows<'a, T: Copy>(
        &'a self,
        keys: &'a [(RunKey, T)],
    ) -> impl Iterator<Item = Result<(SweepRow, T), SweepError>> + 'a {
        let mut files: Vec<Option<File>> = self.journals.iter().map(|_| None).collect();
        let places = keys.iter().filter_map(|(key, beside)| Some((self.places.get(key)?, *beside)));
        places.map(move |(place, beside)| Ok((self.row(&mut files, place)?, beside)))
    }

    fn row(&self, files: &mut [Option<File>], place: &LinePlace) -> Result<SweepRow, SweepError> {
        let path = &self.journals[place.journal as usize];
        let failed = SweepError::file("read", path);
        let file = match &mut files[place.journal as usize] {
            Some(file) => file,
            closed => closed.insert(File::open(path).map_err(&failed)?),
        };
        let mut text = vec![0; place.length as usize];
        file.seek(SeekFrom::Start(place.start)).map_err(&failed)?;
        file.read_exact(&mut text).map_err(&failed)?;
        parsed(path, place.line as usize, &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str) -> SweepRow {
        SweepRow {
            key: RunKey::of_parts(&[name]),
            version: String::new(),
            scenario: name.to_owned(),
            family: String::new(),
            style: String::new(),
            planner: String::new(),
            sample: 0,
            seed: u64::MAX,
            inputs: [("a.b".to_owned(), serde_json::json!(0.1 + 0.2))].into(),
            error: Some("line\nbreak".to_owned()),
            result: None,
            wall_s: 1.0 / 3.0,
            plan_median_ms: None,
            plan_p99_ms: None,
        }
    }

    #[test]
    fn a_torn_line_is_cut_off_and_whole_rows_read_back_exactly() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = path_of(folder.path(), Shard::WHOLE);
        let mut journal = Journal::open(&path).expect("new");
        journal.append(&row("one")).expect("written");
        assert!(matches!(Journal::open(&path), Err(SweepError::InUse(_))), "it is locked");
        drop(journal);
        let whole = fs::read(&path).expect("there");
        for torn in 1..whole.len() - 1 {
            fs::write(&path, [&whole[..], &whole[..torn]].concat()).expect("written");
            assert_eq!(JournalIndex::read(folder.path()).expect("sound").places.len(), 1);
            let mut journal = Journal::open(&path).expect("there");
            journal.append(&row("two")).expect("written");
            let keys = ["two", "one", "three"].map(|name| (RunKey::of_parts(&[name]), name));
            let index = JournalIndex::read(folder.path()).expect("sound");
            let rows: Vec<(SweepRow, &str)> = index.rows(&keys).map(|row| row.expect("sound")).collect();
            assert_eq!(rows, [(row("two"), "two"), (row("one"), "one")]);
        }
    }

    #[test]
    fn a_line_that_does_not_match_its_checksum_is_reported_and_ignored() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal-2-of-3.jsonl");
        let [one, two] = ["one", "two"].map(|name| line_of(&serde_json::to_string(&row(name)).expect("JSON")));
        let unchecked = serde_json::to_string(&row("three")).expect("JSON");
        fs::write(&path, format!("{}{{\"key\": 1}}\n{two}{unchecked}\n", one.replace("0.3", "9.3"))).expect("written");
        let index = JournalIndex::read(folder.path()).expect("read");
        assert_eq!(index.damaged(), [(path.clone(), 1), (path, 2)]);
        assert!(index.holds(RunKey::of_parts(&["two"])) && index.places.len() == 1);
    }

    #[test]
    fn a_damaged_row_that_cannot_be_repeated_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("people.jsonl");
        let line = line_of(&serde_json::to_string(&row("one")).expect("JSON"));
        fs::write(&path, &line).expect("written");
        assert_eq!(read_rows(&path).expect("sound"), [row("one")]);
        fs::write(&path, line.replace("0.3", "9.3")).expect("written");
        let error = read_rows(&path).expect_err("damaged").to_string();
        assert!(error.contains("people.jsonl:1: "), "{error}");
    }
}
