//! What the window costs while it runs: frames, stages of the physics, tests and iterations; and which setting is too dear.

use std::time::Instant;

use game::{Game, ResponseModel};
use physics::{Effect, Effort, Stage, Stopwatch};

/// Time that a report covers [s].
const PERIOD_S: f64 = 0.5;
/// Frames may take this much longer than the display shows them.
const SLACK: f64 = 1.1;
/// A setting is named after so many slow reports in a row: a picture that was covered for a moment says nothing.
const SLOW_REPORTS: u32 = 4;
/// Above this share of a frame the simulation is to blame, whatever the picture takes: that waits for the display, too.
const BLAMED_SHARE: f64 = 0.5;

/// Times of the stages of the physics, by the wall clock.
#[derive(Debug)]
struct Laps {
    last: Instant,
    /// In the order in which they first ran [s].
    stages: Vec<(Stage, f64)>,
}

impl Stopwatch for Laps {
    fn begin(&mut self) {
        self.last = Instant::now();
    }

    fn lap(&mut self, stage: Stage) {
        let now = Instant::now();
        let seconds = now.duration_since(self.last).as_secs_f64();
        self.last = now;
        match self.stages.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, sum)) => *sum += seconds,
            None => self.stages.push((stage, seconds)),
        }
    }
}

/// Measures frame by frame, and reports twice a second.
#[derive(Debug)]
pub struct Meter {
    laps: Laps,
    began: Instant,
    frame_began: Instant,
    frames: u32,
    slowest: f64,
    simulating: f64,
    drawing: f64,
    /// Steps and effort of the game when the report's time began.
    before: (u64, Effort),
    slow_reports: u32,
    has_warned: bool,
    report: Option<Report>,
}

/// What a frame cost in the mean of a report; times in milliseconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    frame: f64,
    slowest: f64,
    drawing: f64,
    simulating: f64,
    stages: Vec<(Stage, f64)>,
    /// Steps in a frame.
    steps: f64,
    /// Per step: looks, pairs of parts spared, pairs of bodies near, pairs of bodies due, iterations.
    counts: [f64; 5],
    effects: Vec<Effect>,
    display_hz: f64,
    step_hz: f64,
    response: ResponseModel,
}

impl Meter {
    /// Begins to measure.
    pub fn new() -> Self {
        let now = Instant::now();
        Self {
            laps: Laps {
                last: now,
                stages: Vec::new(),
            },
            began: now,
            frame_began: now,
            frames: 0,
            slowest: 0.0,
            simulating: 0.0,
            drawing: 0.0,
            before: (0, Effort::default()),
            slow_reports: 0,
            has_warned: false,
            report: None,
        }
    }

    /// The clock for the steps of the physics.
    pub fn stopwatch(&mut self) -> &mut impl Stopwatch {
        &mut self.laps
    }

    /// The last report.
    pub fn report(&self) -> Option<&Report> {
        self.report.as_ref()
    }

    /// A frame that began to be simulated and to be drawn at these times is over, on a display of so many pictures a
    /// second. Returns a warning, once.
    pub fn frame(
        &mut self,
        (simulated, drawn): (Instant, Instant),
        game: &Game,
        display_hz: f64,
    ) -> Option<String> {
        let now = Instant::now();
        self.simulating += drawn.duration_since(simulated).as_secs_f64();
        self.drawing += now.duration_since(drawn).as_secs_f64();
        self.slowest = self
            .slowest
            .max(now.duration_since(self.frame_began).as_secs_f64());
        self.frame_began = now;
        self.frames += 1;
        let elapsed = now.duration_since(self.began).as_secs_f64();
        if elapsed < PERIOD_S {
            return None;
        }
        let report = self.finish(elapsed, game, display_hz);
        self.began = now;
        let warning = report.warning();
        self.slow_reports = if warning.is_some() {
            self.slow_reports + 1
        } else {
            0
        };
        self.report = Some(report);
        let is_due = self.slow_reports >= SLOW_REPORTS && !self.has_warned;
        self.has_warned |= is_due;
        warning.filter(|_| is_due)
    }

    /// The report on what was measured, of which nothing is kept.
    fn finish(&mut self, elapsed: f64, game: &Game, display_hz: f64) -> Report {
        let per_frame = 1e3 / f64::from(self.frames);
        let (steps, effort) = (game.steps(), game.world().effort());
        let (steps_before, before) = self.before;
        let steps_made = steps - steps_before;
        // A new game is a new world, whose counts begin anew.
        let spent = |of: fn(&Effort) -> u64| {
            let (now, before) = (of(&effort), of(&before));
            let spent = now.checked_sub(before).unwrap_or(now);
            spent as f64 / steps_made.max(1) as f64
        };
        let counts = [
            spent(|effort| effort.looks),
            spent(|effort| effort.spared),
            spent(|effort| effort.near),
            spent(|effort| effort.due),
            spent(|effort| effort.iterations),
        ];
        let plan: Vec<_> = game.world().plan().map(|planned| planned.effects).collect();
        let acts = |effect: &Effect| plan.iter().any(|effects| effects.contains(*effect));
        let physics = &game.config().physics;
        let report = Report {
            frame: elapsed * per_frame,
            slowest: 1e3 * self.slowest,
            drawing: self.drawing * per_frame,
            simulating: self.simulating * per_frame,
            stages: self
                .laps
                .stages
                .drain(..)
                .map(|(stage, seconds)| (stage, seconds * per_frame))
                .collect(),
            steps: steps_made as f64 / f64::from(self.frames),
            counts,
            effects: Effect::ALL.into_iter().filter(acts).collect(),
            display_hz,
            step_hz: physics.step_hz,
            response: physics.response,
        };
        self.before = (steps, effort);
        (self.frames, self.slowest) = (0, 0.0);
        (self.simulating, self.drawing) = (0.0, 0.0);
        report
    }
}

impl Report {
    /// Everything, in lines of fixed width.
    pub fn text(&self) -> String {
        let mut text = format!(
            "frame       {:7.2} ms, slowest {:.1}; display {:.0} Hz\n\
             drawing     {:7.2} ms\n\
             simulation  {:7.2} ms, {:.1} steps\n",
            self.frame, self.slowest, self.display_hz, self.drawing, self.simulating, self.steps
        );
        for (stage, time) in &self.stages {
            text += &format!("  {:<10}{time:7.3} ms\n", stage.name());
        }
        let [looks, spared, near, due, iterations] = self.counts;
        text += &format!(
            "a step looks at {looks:.1} pairs of parts, spares {spared:.1}\n\
             {due:.1} of {near:.1} near bodies' pairs due, {:.1} wait\n\
             {iterations:.1} iterations of the detection\n",
            near - due
        );
        let mut line = "plan:".to_owned();
        for effect in &self.effects {
            if line.len() + effect.name().len() > 46 {
                text += &(line + "\n");
                line = "     ".to_owned();
            }
            line += &format!(" {}", effect.name());
        }
        text += &line;
        if let Some(warning) = self.warning() {
            text += &format!("\n{warning}");
        }
        text
    }

    /// Which setting keeps the display's rate from being held, and what would lower it.
    pub fn warning(&self) -> Option<String> {
        let budget = 1e3 / self.display_hz;
        if self.frame <= SLACK * budget {
            return None;
        }
        let held = format!(
            "{:.0} of {:.0} pictures a second:",
            1e3 / self.frame,
            self.display_hz
        );
        let is_simulation =
            self.simulating > BLAMED_SHARE * budget || self.simulating > self.drawing;
        if !is_simulation {
            return Some(format!(
                "{held} drawing takes {:.1} ms;\nshows.materials=false or a smaller window would take less",
                self.drawing
            ));
        }
        let dearest = self.stages.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let (stage, time) = dearest.map_or(("none", 0.0), |(stage, time)| (stage.name(), *time));
        Some(format!(
            "{held} stage {stage} takes {time:.1} of {:.1} ms;\n{} would take less",
            self.simulating,
            self.dial(dearest.map(|(stage, _)| *stage))
        ))
    }

    /// The setting that lowers what a stage costs. docs/accuracy.md measures them.
    fn dial(&self, dearest: Option<Stage>) -> String {
        let is_sweeping = self.response == ResponseModel::Coulomb;
        match dearest {
            // Sweeps run until they agree; the paper's laws answer each contact once.
            Some(Stage::Carry) if is_sweeping => "physics.response=\"guarded\"".to_owned(),
            Some(Stage::Slow | Stage::SlowAgain) => "physics.effects without \"drag\"".to_owned(),
            _ => {
                // Whole steps in a frame of the display, where there can be.
                let fewer = (self.step_hz / 2.0).max(60.0);
                format!("physics.step_hz={fewer:.1} instead of {:.1}", self.step_hz)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(frame: f64, simulating: f64, drawing: f64) -> Report {
        Report {
            frame,
            slowest: frame,
            drawing,
            simulating,
            stages: vec![
                (Stage::Carry, 0.2 * simulating),
                (Stage::Strike, 0.7 * simulating),
            ],
            steps: 12.0,
            counts: [3.0, 40.0, 60.0, 2.0, 1.5],
            effects: vec![Effect::Gravity, Effect::Friction],
            display_hz: 60.0,
            step_hz: 720.0,
            response: ResponseModel::UnoSlater,
        }
    }

    #[test]
    fn text_says_what_every_line_measures() {
        let text = report(16.7, 1.0, 12.0).text();
        for words in [
            "frame         16.70 ms",
            "drawing       12.00 ms",
            "strike      0.700 ms",
            "looks at 3.0 pairs of parts, spares 40.0",
            "2.0 of 60.0 near bodies' pairs due, 58.0 wait",
            "1.5 iterations",
            "plan: gravity friction",
        ] {
            assert!(text.contains(words), "no `{words}` in:\n{text}");
        }
        assert!(!text.contains("pictures a second"), "{text}");
    }

    #[test]
    fn warning_blames_the_dearest_stage_or_the_picture() {
        assert_eq!(report(17.0, 14.0, 1.0).warning(), None);
        let slow = report(40.0, 30.0, 8.0)
            .warning()
            .expect("25 of 60 a second");
        assert!(
            slow.contains("25 of 60") && slow.contains("stage strike takes 21.0 of 30.0"),
            "{slow}"
        );
        assert!(
            slow.contains("physics.step_hz=360.0 instead of 720.0"),
            "{slow}"
        );
        let drawn = report(40.0, 2.0, 37.0).warning().expect("as slow");
        assert!(
            drawn.contains("drawing takes 37.0 ms") && drawn.contains("shows.materials=false"),
            "{drawn}"
        );
        // The picture waits for the display, so that it looks dearer than it is.
        let waiting = report(33.3, 10.0, 23.0)
            .warning()
            .expect("30 of 60 a second");
        assert!(waiting.contains("stage strike"), "{waiting}");
    }

    #[test]
    fn warning_names_the_law_where_sweeps_are_dearest() {
        let mut slow = report(40.0, 30.0, 8.0);
        slow.response = ResponseModel::Coulomb;
        slow.stages[0].1 = 29.0;
        let text = slow.warning().expect("25 of 60 a second");
        assert!(
            text.contains("stage carry") && text.contains("physics.response=\"guarded\""),
            "{text}"
        );
    }
}
