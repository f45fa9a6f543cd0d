//! Reads a journal back, and says in one sentence with file and line what is wrong with it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use experiment::journal::{Lines, Torn};
use game::{Conditions, Input};

use super::{Changes, End, Entry, Header, settings};

/// A whole session.
#[derive(Debug)]
pub struct Recording {
    /// What the session was; of one that was resumed, its last part.
    pub header: Header,
    /// The settings that it was played with.
    pub conditions: Conditions,
    /// What the game consumed, frame by frame.
    pub inputs: Vec<Input>,
    /// What was laid out before which input.
    pub changes: Changes,
    /// What happened: the index of its input, and the event as recorded.
    pub events: Vec<(usize, serde_json::Value)>,
    /// How it ended.
    pub end: End,
}

/// A journal as far as it goes: its session may be under way, or was killed.
#[derive(Debug)]
pub struct Story {
    /// What the session was.
    pub header: Header,
    /// What the game consumed, frame by frame.
    pub inputs: Vec<Input>,
    /// What happened: the index of its input, and the event as recorded.
    pub events: Vec<(usize, serde_json::Value)>,
    /// What the experiment noted: how many inputs there were before it, and the note.
    pub notes: Vec<(usize, serde_json::Value)>,
    /// What the device said of itself, but for its pictures and throws.
    pub device: Vec<DeviceLine>,
    /// How it ended, if it did in order.
    pub end: Option<End>,
    /// The last line, where a crash cut it short.
    pub torn: Option<Torn>,
    /// Number of the last whole line.
    pub lines: usize,
    /// How many inputs have all their events: a crash may have come between two events of the last one.
    pub whole: usize,
}

/// Something that the device said of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceLine {
    /// How many inputs there were before it.
    pub at: usize,
    /// The runtime's time of the last picture before it [s]; goes on while the game waits. `None` without a headset.
    pub time_s: Option<f64>,
    /// What it said.
    pub said: serde_json::Value,
}

/// Reads the journal of a session that was closed, and of one that was resumed the parts before it.
///
/// # Errors
/// When it cannot be read, is no journal, is of another version, was cut short or was changed.
pub fn read(path: &Path) -> Result<Recording> {
    let story = read_open(path)?;
    let Story {
        header,
        inputs,
        events,
        notes,
        end,
        torn,
        lines,
        ..
    } = story;
    if let Some(torn) = torn {
        bail!(
            "{} line {}: the line is not complete: the recording was cut short and cannot be checked",
            path.display(),
            torn.line
        );
    }
    let end = end.with_context(|| {
        format!(
            "{} line {}: the recording stops here, before its end: it was cut short and cannot be checked",
            path.display(),
            lines
        )
    })?;
    Ok(Recording {
        conditions: settings::of(path, &header)?,
        changes: Changes::of(path, &header, &notes)?,
        header,
        inputs,
        events,
        end,
    })
}

/// Puts what counts of the journals before `story` in front of it.
fn prepend_earlier(path: &Path, story: &mut Story) -> Result<()> {
    let Some(continues) = &story.header.continues else {
        return Ok(());
    };
    let earlier = path.with_file_name(&continues.journal);
    let before = read_open(&earlier)?;
    let count = continues.inputs as usize;
    if before.inputs.len() < count {
        bail!(
            "{} has {} inputs, but {} goes on behind input {count}: its end is missing",
            earlier.display(),
            before.inputs.len(),
            path.display()
        );
    }
    let shift = |(at, value): (usize, serde_json::Value)| (at + count, value);
    let mut inputs = before.inputs;
    inputs.truncate(count);
    inputs.append(&mut story.inputs);
    let mut events = before.events;
    events.retain(|(at, _)| *at < count);
    events.extend(std::mem::take(&mut story.events).into_iter().map(shift));
    let mut notes = kept(before.notes, count);
    notes.extend(std::mem::take(&mut story.notes).into_iter().map(shift));
    (story.inputs, story.events, story.notes) = (inputs, events, notes);
    let mut device = before.device;
    device.retain(|line| line.at <= count);
    device.extend(std::mem::take(&mut story.device).into_iter().map(|line| {
        let at = line.at + count;
        DeviceLine { at, ..line }
    }));
    story.device = device;
    story.whole += count;
    Ok(())
}

/// The notes of a session that goes on behind input `count`: what was answered or noted counts wherever that is, and happened
/// before what follows; what was laid out behind it does not.
pub fn kept(
    notes: Vec<(usize, serde_json::Value)>,
    count: usize,
) -> Vec<(usize, serde_json::Value)> {
    notes
        .into_iter()
        .filter(|(at, note)| *at < count || note["note"] != "throw")
        .map(|(at, note)| (at.min(count), note))
        .collect()
}

/// Reads a journal as far as it goes, behind what counts of those that it continues.
///
/// # Errors
/// When it cannot be read, is no journal, is of another version or was changed.
pub fn read_open(path: &Path) -> Result<Story> {
    let bytes = fs::read(path).with_context(|| {
        format!(
            "cannot read {}: give the folder that `bowling play` printed at its end, or a session's of a study, data/sourcedata/sub-.../ses-01",
            path.display()
        )
    })?;
    let mut lines = Lines::new(&bytes);
    let mut story = tell(&mut lines)
        .map_err(|problem| anyhow!("{} line {}: {problem}", path.display(), lines.number()))?;
    prepend_earlier(path, &mut story)?;
    Ok(story)
}

/// The next line, understood.
fn next_entry(lines: &mut Lines) -> Result<Option<Entry>> {
    let Some(content) = lines.next_content()? else {
        return Ok(None);
    };
    serde_json::from_str(&content)
        .map(Some)
        .map_err(|error| anyhow!("cannot be understood ({error})"))
}

fn tell(lines: &mut Lines) -> Result<Story> {
    let Some(Entry::Header(header)) = next_entry(lines)? else {
        bail!("no header, so this is not a journal of this program");
    };
    let mut story = Story {
        header: *header,
        inputs: Vec::new(),
        events: Vec::new(),
        notes: Vec::new(),
        device: Vec::new(),
        end: None,
        torn: None,
        lines: 1,
        whole: 0,
    };
    let mut time_s = None;
    while let Some(entry) = next_entry(lines)? {
        if story.end.is_some() {
            bail!("something follows the end of the session");
        }
        // Events are written right behind their input, and all else behind them.
        if !matches!(entry, Entry::Event(_)) {
            story.whole = story.inputs.len();
        }
        match entry {
            Entry::Header(_) => bail!("a second header"),
            Entry::Input(line) => story.inputs.push(Input::from(&line)),
            Entry::Event(event) => match story.inputs.len().checked_sub(1) {
                Some(input) => story.events.push((input, event)),
                None => bail!("an event before the first input"),
            },
            Entry::Device(said) => {
                if let Some(time) = said["frame"]["xr_time_ns"].as_i64() {
                    time_s = Some(time as f64 * 1e-9);
                } else if said.get("throw").is_none() && said.get("after_throw").is_none() {
                    let at = story.inputs.len();
                    story.device.push(DeviceLine { at, time_s, said });
                }
            }
            Entry::Study(note) => story.notes.push((story.inputs.len(), note)),
            Entry::End(end) => story.end = Some(end),
        }
    }
    story.torn = lines.torn();
    story.lines = lines.number() - usize::from(story.torn.is_some());
    Ok(story)
}
