//! Runs scenes for a number of frames on one thread and prints a line of JSON for each: the name of its file, the hash
//! of its state, seconds of processor time, and the profile of the build. What a browser and Node are compared with.
//!
//! Usage: `cargo run -p unipbd-web --example hashes -- FRAMES SCENE...`

use std::path::Path;

use cpu_time::ThreadTime;
use serde_json::json;
use unipbd_web::Session;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let frames: u32 = arguments.next().ok_or("the number of frames is missing")?.parse()?;
    for path in arguments {
        let text = std::fs::read_to_string(&path)?;
        let mut session = Session::new(&text, "").map_err(|mistakes| mistakes.to_string())?;
        let begin = ThreadTime::now();
        for _ in 0..frames {
            session.step().map_err(|failure| failure.to_string())?;
        }
        let seconds = begin.elapsed().as_secs_f64();
        let name = Path::new(&path).file_stem().unwrap_or_default().to_string_lossy();
        let build = if cfg!(debug_assertions) { "debug" } else { "release" };
        let line = json!({
            "scene": name,
            "hash": format!("{:016x}", session.hash()),
            "seconds": seconds,
            "build": build,
        });
        println!("{line}");
    }
    Ok(())
}
