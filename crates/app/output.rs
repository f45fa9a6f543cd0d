//! The folder that a session leaves, and files that appear in it only when they are whole.

use std::fs::{self, File};
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result, bail};

/// The one source of truth: all that the game consumed.
pub const JOURNAL: &str = "journal.jsonl";
/// Head and hand in the world, derived from the journal.
pub const MOTION: &str = "motion.tsv";

/// A new session's folder.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// The folders that were made for it, innermost first.
    made: Vec<PathBuf>,
}

impl OutputFolder {
    /// Creates the folder; one that holds anything already is refused.
    ///
    /// # Errors
    /// When it is not empty or cannot be written.
    pub fn create(path: &Path) -> Result<Self> {
        if path.join(JOURNAL).exists() {
            bail!(
                "{} holds a recording already, and recordings are never overwritten: choose another folder with --out",
                path.display()
            );
        }
        if fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some()) {
            bail!(
                "{} is not empty, and nothing in it is overwritten: choose a new or empty folder with --out",
                path.display()
            );
        }
        let advice = || {
            format!(
                "cannot write into {}: choose a writable folder with --out",
                path.display()
            )
        };
        let missing = path.ancestors().take_while(|folder| !folder.exists());
        let folder = OutputFolder {
            path: path.to_path_buf(),
            made: missing.map(Path::to_path_buf).collect(),
        };
        // Found out now rather than after a game.
        let trial = fs::create_dir_all(path)
            .map_err(anyhow::Error::from)
            .and_then(|()| Draft::create(path, "trial"))
            .with_context(advice);
        if let Err(error) = trial {
            folder.abandon();
            return Err(error);
        }
        Ok(folder)
    }

    /// Takes back the folders that were made for a session that could not begin.
    pub fn abandon(self) {
        for folder in &self.made {
            // One that holds something, or refuses to go, is no worse than one that stays.
            let _ = fs::remove_dir(folder);
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Starts a file that appears under `name` only once it is finished.
    ///
    /// # Errors
    /// When the folder cannot be written any more.
    pub fn draft(&self, name: &str) -> Result<Draft> {
        Draft::create(&self.path, name)
    }

    /// Writes a whole file at once.
    ///
    /// # Errors
    /// When the folder cannot be written any more.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf> {
        let mut draft = self.draft(name)?;
        draft
            .write_all(content)
            .with_context(|| format!("cannot write {}", self.path.join(name).display()))?;
        draft.finish()
    }
}

/// A file under a temporary name, renamed when finished and removed when dropped before that.
#[derive(Debug)]
pub struct Draft {
    /// `None` once finished.
    file: Option<BufWriter<File>>,
    temporary: PathBuf,
    target: PathBuf,
}

impl Draft {
    /// Starts a file at `path`, which appears only once it is finished.
    ///
    /// # Errors
    /// When the path names no file, or its folder cannot be written.
    pub fn at(path: &Path) -> Result<Self> {
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.with_context(|| format!("{} is no name of a file", path.display()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::create(folder, name)
    }

    fn create(folder: &Path, name: &str) -> Result<Self> {
        let target = folder.join(name);
        let temporary = folder.join(format!(".{name}.part"));
        let file = File::create(&temporary)
            .with_context(|| format!("cannot create {}", target.display()))?;
        Ok(Draft {
            file: Some(BufWriter::new(file)),
            temporary,
            target,
        })
    }

    /// Syncs the content to disk and gives the file its name; returns its path.
    ///
    /// # Errors
    /// When the disk is full or gone.
    pub fn finish(mut self) -> Result<PathBuf> {
        let failed = format!("cannot finish {}", self.target.display());
        let writer = self
            .file
            .take()
            .expect("finish consumes the draft, so it runs once");
        let written = writer
            .into_inner()
            .map_err(std::io::IntoInnerError::into_error)
            .and_then(|file| file.sync_all())
            .and_then(|()| fs::rename(&self.temporary, &self.target));
        if written.is_err() {
            self.remove();
        }
        written.context(failed)?;
        Ok(self.target.clone())
    }

    fn writer(&mut self) -> &mut BufWriter<File> {
        self.file
            .as_mut()
            .expect("only finish takes the file, and it consumes the draft")
    }

    fn remove(&self) {
        // Nothing more can be done about a folder that refuses even this, and the error that led
        // here is reported already.
        let _ = fs::remove_file(&self.temporary);
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.writer().flush()
    }
}

impl Seek for Draft {
    fn seek(&mut self, position: SeekFrom) -> std::io::Result<u64> {
        self.writer().seek(position)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            self.remove();
        }
    }
}

/// The default folder of a session: `out/TIME-seedN`, UTC below the current one.
pub fn default_folder(seed: u64, now: SystemTime) -> PathBuf {
    timed_folder(&format!("seed{seed}"), now)
}

/// A folder for something that is made now: `out/TIME-NAME`, UTC below the current one.
pub fn timed_folder(name: &str, now: SystemTime) -> PathBuf {
    let seconds = now
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    Path::new("out").join(format!("{}-{name}", utc_name(seconds)))
}

/// A time in UTC, `YYYY-MM-DDThh:mm:ssZ` (RFC 3339).
pub fn utc_time(time: SystemTime) -> String {
    let seconds = time
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    let name = utc_name(seconds);
    let (date, time) = name.split_at(10);
    date.to_owned() + &time.replace('-', ":")
}

/// The time that is `seconds` after `utc`, both as [`utc_time`] writes them; `None` where `utc` is none.
pub fn utc_later(utc: &str, seconds: f64) -> Option<String> {
    let number = |range: std::ops::Range<usize>| utc.get(range)?.parse::<i64>().ok();
    let days = days_since_1970(number(0..4)?, number(5..7)?, number(8..10)?);
    let within = number(11..13)? * 3600 + number(14..16)? * 60 + number(17..19)?;
    let later = u64::try_from(days * 86_400 + within + seconds.floor() as i64).ok()?;
    Some(utc_time(UNIX_EPOCH + std::time::Duration::from_secs(later)))
}

/// Days from 1970-01-01 to a date: the inverse of [`civil_date`], from the same source, `days_from_civil`.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let year = year - i64::from(month <= 2);
    let era = year.div_euclid(400);
    let year_of_era = year.rem_euclid(400);
    let shifted_month = (month + 9) % 12;
    let day_of_year = (153 * shifted_month + 2) / 5 + day - 1;
    let day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
    era * 146_097 + day_of_era - 719_468
}

/// `seconds` since 1970 as a UTC time that sorts and is a file name on every system.
fn utc_name(seconds: u64) -> String {
    let (year, month, day) = civil_date((seconds / 86_400) as i64);
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}-{minute:02}-{second:02}Z")
}

/// Year, month, day of a day counted from 1970-01-01.
///
/// Howard Hinnant, *chrono-Compatible Low-Level Date Algorithms*, `civil_from_days`: years start in
/// March, so that the leap day is the last of its year.
fn civil_date(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468;
    let era = days.div_euclid(146_097);
    let day_of_era = days.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    };
    (year_of_era + era * 400 + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utc_name_of_known_instants() {
        assert_eq!(utc_name(0), "1970-01-01T00-00-00Z");
        assert_eq!(utc_name(951_827_696), "2000-02-29T12-34-56Z");
        assert_eq!(utc_name(1_767_225_599), "2025-12-31T23-59-59Z");
    }

    #[test]
    fn utc_time_is_that_of_rfc_3339() {
        let time = UNIX_EPOCH + std::time::Duration::from_secs(951_827_696);
        assert_eq!(utc_time(time), "2000-02-29T12:34:56Z");
    }

    #[test]
    fn utc_later_goes_over_midnights_and_leap_days() {
        let later = |utc, seconds| utc_later(utc, seconds).expect("a time");
        assert_eq!(later("2024-02-28T23:59:30Z", 30.9), "2024-02-29T00:00:00Z");
        assert_eq!(
            later("1999-12-31T23:00:00Z", 3600.0),
            "2000-01-01T00:00:00Z"
        );
        for day in (0..40_000).step_by(13) {
            let (year, month, date) = civil_date(day);
            assert_eq!(days_since_1970(year, month, date), day);
        }
        assert_eq!(utc_later("yesterday", 1.0), None);
    }

    #[test]
    fn draft_appears_only_when_finished() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let output = OutputFolder::create(&folder.path().join("new/deep")).expect("writable");
        let mut draft = output.draft("a.txt").expect("writable");
        draft.write_all(b"whole").expect("writable");
        assert!(!output.path().join("a.txt").exists());
        let path = draft.finish().expect("writable");
        assert_eq!(fs::read(path).expect("written"), b"whole");
    }

    #[test]
    fn draft_dropped_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let output = OutputFolder::create(folder.path()).expect("writable");
        let mut draft = output.draft("a.txt").expect("writable");
        draft.write_all(b"half").expect("writable");
        drop(draft);
        assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 0);
    }

    #[test]
    fn create_refuses_a_folder_with_a_recording() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join(JOURNAL), "{}").expect("writable");
        let error = OutputFolder::create(folder.path()).expect_err("a recording is there");
        assert!(error.to_string().contains("never overwritten"), "{error}");
    }

    #[test]
    fn abandon_removes_what_create_made_and_no_more() {
        let outer = tempfile::tempdir().expect("a temporary folder");
        let path = outer.path().join("new/deep");
        OutputFolder::create(&path).expect("writable").abandon();
        assert_eq!(fs::read_dir(outer.path()).expect("there").count(), 0);
        OutputFolder::create(outer.path())
            .expect("writable")
            .abandon();
        assert!(outer.path().exists());
    }

    #[test]
    fn create_says_where_it_cannot_write() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("file");
        fs::write(&file, "in the way").expect("writable");
        let error = OutputFolder::create(&file.join("out")).expect_err("a file is in the way");
        assert!(error.to_string().contains("--out"), "{error}");
    }
}
