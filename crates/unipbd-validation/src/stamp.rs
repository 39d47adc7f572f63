//! Where figures come from: the day, the commit and the machine they were measured at.

use std::process::Command;

use unipbd_core::simd::Level;

/// Processor, hardware threads, instruction set and compiler.
pub fn machine() -> String {
    let information = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = information.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown processor");
    let model = model.trim_start_matches(['\t', ' ', ':']);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let compiler = output("rustc", &["--version"]).unwrap_or_else(|| "compiler unknown".to_owned());
    format!("{model}, {threads} hardware threads, {:?}; {compiler}", Level::best())
}

/// Day and commit of this moment, such as `2026-11-28, commit 1a2b3c4`; says so where the code has changes on top.
pub fn stamp() -> String {
    let day = output("date", &["-u", "+%F"]).unwrap_or_else(|| "a day unknown".to_owned());
    let Some(commit) = output("git", &["rev-parse", "--short=7", "HEAD"]) else {
        return format!("{day}, outside of a repository");
    };
    // Documents change with the figures; the code that gave them must not have.
    let code = ["status", "--porcelain", "--untracked-files=no", "--", ":/crates", ":/benches", ":/Cargo.lock"];
    let changed = output("git", &code).is_none_or(|changes| !changes.is_empty());
    format!("{day}, commit {commit}{}", if changed { " with changes" } else { "" })
}

/// Output of a program, trimmed; nothing where it fails.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
