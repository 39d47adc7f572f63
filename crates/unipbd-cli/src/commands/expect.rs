//! `expect`: do scenes do what they say they do?

use std::path::Path;
use std::time::Instant;

use serde_json::json;
use unipbd_core::BuildOptions;

use super::scene::{load, threads};
use crate::args::ExpectArgs;
use crate::exit::{Exit, Failure};
use crate::expect::Watch;
use crate::report::{Console, Form};
use crate::simulation::Simulation;

/// Result of one scene.
struct Verdict {
    violations: Vec<String>,
    summary: String,
    seconds: f64,
}

pub(super) fn expect(arguments: &ExpectArgs, console: Console) -> Result<Exit, Failure> {
    let mut exit = Exit::Success;
    for path in &arguments.scenes {
        let verdict = watch(path, arguments)?;
        if !verdict.violations.is_empty() {
            exit = Exit::ConditionMet;
        }
        show(path, &verdict, console)?;
    }
    Ok(exit)
}

/// Runs a scene to its end, or to where it diverges.
fn watch(path: &Path, arguments: &ExpectArgs) -> Result<Verdict, Failure> {
    let start = Instant::now();
    let loaded = load(path, &arguments.changes)?;
    let mut simulation =
        Simulation::new(&loaded.scene, BuildOptions { threads: threads(arguments.threads)?, seed: None });
    let mut watch = Watch::new(&loaded.scene);
    watch.observe(&simulation.solver);
    let mut diverged = None;
    while let Some(frame) = simulation.next_frame() {
        watch.observe(&simulation.solver);
        if let Err(error) = frame {
            diverged = Some(error.to_string());
            break;
        }
    }
    let violations = match diverged {
        Some(error) => vec![error],
        None => watch.violations(&simulation.solver),
    };
    Ok(Verdict { violations, summary: watch.summary(), seconds: start.elapsed().as_secs_f64() })
}

fn show(path: &Path, verdict: &Verdict, console: Console) -> Result<(), Failure> {
    let held = verdict.violations.is_empty();
    match console.form {
        Form::Json => console.object(&json!({
            "type": "expect",
            "scene": path.display().to_string(),
            "holds": held,
            "violations": verdict.violations,
            "summary": verdict.summary,
            "wall_time": verdict.seconds,
        }))?,
        Form::Text => {
            let word = if held { "ok    " } else { "FAILED" };
            console.line(format_args!("{word} {} ({:.1} s): {}", path.display(), verdict.seconds, verdict.summary))?;
            for line in &verdict.violations {
                console.line(format_args!("       {line}"))?;
            }
        }
    }
    Ok(())
}
