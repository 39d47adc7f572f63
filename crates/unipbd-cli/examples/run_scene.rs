//! A scene file run from Rust.
//!
//! ```sh
//! cargo run -p unipbd-cli --example run_scene -- scenes/dam_break.toml 30
//! ```
//!
//! Prints the time, the number of particles and the hash of the state after so many frames.

use std::error::Error;

use unipbd_cli::scene_file;
use unipbd_core::BuildOptions;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(path), Some(frames)) = (arguments.next(), arguments.next()) else {
        return Err("usage: run_scene SCENE.toml FRAMES".into());
    };
    let loaded = scene_file::load(path, &[])?;
    let mut solver = loaded.scene.build(BuildOptions::default());
    for _ in 0..frames.parse::<u32>()? {
        solver.step_frame()?;
    }
    println!("{:.6} s, {} particles, state {:016x}", solver.time(), solver.ids().len(), solver.state_hash());
    Ok(())
}
