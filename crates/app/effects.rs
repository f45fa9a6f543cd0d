//! `bowling effects`: what a scene calls for and shows, and what each effect costs.

mod measure;
mod shown;

use std::io::{self, Write};
use std::path::Path;

use anyhow::{Context, Result};
use game::{Config, EffectName};
use physics::{Effect, World};

use crate::args::{EffectsArguments, EffectsOf};
use measure::{Bench, Cost};
use shown::Shown;

/// Prints the plan of the scene with the table of its effects, then what its pictures and its sound take.
///
/// # Errors
/// When the scene's settings cannot be used, or the output not be written.
pub fn effects(arguments: &EffectsArguments, root: &Path) -> Result<()> {
    let mut output = io::stdout().lock();
    let mut write = |text: &str| -> Result<()> {
        writeln!(output, "{text}").context("the table cannot be written")?;
        output.flush().context("the table cannot be written")
    };
    let folder = root.join("config");
    let config = Config::load(&folder, &arguments.scene, None, &arguments.settings)?;
    if arguments.of.contains(&EffectsOf::Physics) {
        let bench = Bench::new(&config, arguments.throws)?;
        write(&plan(&arguments.scene, bench.world()))?;
        write(HEAD)?;
        for effect in Effect::ALL {
            write(&row(&config, &bench, effect)?)?;
        }
        write(LEGEND)?;
    }
    let shown = Shown::new(root, &arguments.scene, &arguments.settings);
    if arguments.of.contains(&EffectsOf::Pictures) {
        shown.pictures(&mut write)?;
    }
    if arguments.of.contains(&EffectsOf::Sound) {
        write(SOUND)?;
        write(&shown.sound()?)?;
    }
    Ok(())
}

const HEAD: &str = "\
effect              in the plan   acts  step with  without   share   throw with  without
                                 /step         us       us       %         ms/s     ms/s";

const SOUND: &str = "
heard               in scene    with [ms/s]  without   of one core, for each second of a frame that the scripted participant bowls";

const LEGEND: &str = "
step    the same states of several throws, some steps from each: with and without the effect, all else as the scene has it
throw   whole throws of 4 s per simulated second of one core; without an effect other things happen, so it may well be dearer
share   of the step with the effect; a few percent are the clock's noise, and what is put somewhere is awake, so that
        sleeping saves time in whole throws alone
plan    no: not listed; uncalled: listed, but nothing in the scene calls for it";

/// The stages of a step and the effects in each.
fn plan(scene: &str, world: &World) -> String {
    let settings = world.settings();
    let mut text = format!(
        "Scene {scene}: {:?}, {} steps a second\n",
        settings.response, settings.step_hz
    );
    for planned in world.plan() {
        let stage = planned.stage;
        let names: Vec<&str> = planned.effects.iter().map(Effect::name).collect();
        let line = format!(
            "  {:<11}{:<46}{}",
            stage.name(),
            stage.purpose(),
            names.join(", ")
        );
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// One effect's line.
fn row(config: &Config, bench: &Bench, effect: Effect) -> Result<String> {
    let name = EffectName(effect);
    let is_listed = config.physics.effects.contains(&name);
    let set = |is_listed: bool| {
        let mut config = config.clone();
        let effects = &mut config.physics.effects;
        effects.retain(|other| *other != name);
        if is_listed {
            effects.push(name);
        }
        config
    };
    let (with, without) = bench.compare(&set(true), &set(false))?;
    let state = match (is_listed, with.acts_in_plan(effect)) {
        (true, true) => "yes",
        (true, false) => "uncalled",
        (false, _) => "no",
    };
    let share = 1e2 * (1.0 - without.step / with.step);
    let Cost { step, throw, .. } = with;
    let acts = with.acts(effect);
    Ok(format!(
        "{:<20}{state:<12}{acts:>6.1} {step:>10.2} {:>8.2} {share:>7.1} {throw:>12.3} {:>8.3}",
        effect.name(),
        without.step,
        without.throw
    ))
}
