//! `inroads train`.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use super::{Done, evaluate::report, plot::drawn, progress::Progress, world};
use crate::{
    config::{Config, ConfigError},
    run::{Ended, Run},
};

/// What `inroads train` takes.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The agent (see `inroads list`)
    agent: String,
    /// The environment (see `inroads list`)
    environment: String,
    /// The seed from which all random numbers of the run come
    #[arg(long)]
    seed: Option<u64>,
    /// The backend of Burn: flex or ndarray
    #[arg(long)]
    backend: Option<String>,
    /// The run's folder (default: runs/AGENT-ENVIRONMENT-SEED)
    #[arg(long)]
    out: Option<PathBuf>,
    /// Go on from the newest checkpoint of the run's folder
    #[arg(long)]
    resume: bool,
    /// With --resume: go on from this checkpoint instead
    #[arg(long, requires = "resume")]
    checkpoint: Option<PathBuf>,
    /// Read settings from a TOML file
    #[arg(long, conflicts_with = "resume")]
    config: Option<PathBuf>,
    /// Set one value, such as `chain.gestation=3` (may be given again); with --resume only how long to train:
    /// `episodes` and `max_steps`
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    world: world::Arguments,
}

pub(super) fn train(arguments: &Arguments) -> Done {
    let config = Config::asked(&arguments.agent, &arguments.environment, |config| asked(config, arguments))?;
    let settings = &config.settings;
    let default = || format!("runs/{}-{}-{}", settings.agent, settings.environment, settings.seed).into();
    let path = arguments.out.clone().unwrap_or_else(default);
    let mut run = if arguments.resume {
        let mut run = Run::resume(&path, arguments.checkpoint.as_deref())?;
        agree(arguments, &run.config)?;
        if !arguments.set.is_empty() {
            let longer = assigned(run.config.clone(), &arguments.set)?;
            run.lengthen(&longer)?;
        }
        run
    } else {
        Run::create(config, &path)?
    };
    let (episodes, steps) = run.session.progress();
    if arguments.resume {
        eprintln!("resumed {} after {episodes} episodes ({steps} steps)", path.display());
    }

    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    // Without a handler Ctrl-C ends the process, and the newest checkpoint stands: no reason not to train.
    let _handled = ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed));
    let mut progress = Progress::new(&run.config.settings, episodes);
    let ended = run.train(&stop, |metrics| progress.show(metrics))?;
    progress.finish();
    match ended {
        Ended::Interrupted => {
            eprintln!("stopped and saved; go on with\n  {}", resume_command(&run, &path));
            Ok(())
        }
        Ended::Complete => {
            let (summary, frozen) = run.summarise()?;
            report(&summary);
            drawn(&mut run, &frozen)
        }
    }
}

/// What was asked for in the place of what was there.
fn asked(mut config: Config, arguments: &Arguments) -> Result<Config, ConfigError> {
    if let Some(file) = &arguments.config {
        config = config.with_file(file)?;
    }
    config = assigned(config, &arguments.set)?;
    arguments.world.put(&mut config.settings.world)?;
    if let Some(seed) = arguments.seed {
        config.settings.seed = seed;
    }
    if let Some(backend) = &arguments.backend {
        config = config.with_assignment(&format!("backend=\"{backend}\""))?;
    }
    Ok(config)
}

fn assigned(config: Config, assignments: &[String]) -> Result<Config, ConfigError> {
    config.with_assignments(assignments.iter().map(String::as_str))
}

/// A run goes on as it was begun: what is asked of it must not differ.
fn agree(arguments: &Arguments, config: &Config) -> Result<(), ConfigError> {
    let settings = &config.settings;
    let mut world = settings.world.clone();
    arguments.world.put(&mut world)?;
    if world != settings.world {
        let why = "the run has another map, scale, body, see or layout; leave them out, or begin another run"
            .to_owned();
        return Err(ConfigError::Impossible { table: "the resumed run".into(), why });
    }
    let asked = [
        ("agent", Some(arguments.agent.clone()), settings.agent.clone()),
        ("environment", Some(arguments.environment.clone()), settings.environment.clone()),
        ("seed", arguments.seed.map(|seed| seed.to_string()), settings.seed.to_string()),
        ("backend", arguments.backend.clone(), settings.backend.to_string()),
    ];
    for (name, asked, is) in asked {
        if asked.as_ref().is_some_and(|asked| *asked != is) {
            let asked = asked.unwrap_or_default();
            let why = format!("the run has {name} `{is}`, not `{asked}`; leave it out, or begin another run");
            return Err(ConfigError::Impossible { table: "the resumed run".into(), why });
        }
    }
    Ok(())
}

fn resume_command(run: &Run, path: &Path) -> String {
    let settings = &run.config.settings;
    format!("inroads train {} {} --out {} --resume", settings.agent, settings.environment, path.display())
}
