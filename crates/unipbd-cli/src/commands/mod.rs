//! The commands, one file each.

mod bench;
mod check;
mod completions;
mod estimate;
mod expect;
mod export;
mod info;
mod layout;
mod manual;
mod plot;
mod recording;
mod recover;
mod render;
mod run;
mod scene;
mod schema;

use crate::args::Command;
use crate::exit::{Exit, Failure};
use crate::report::Console;

/// Does what the arguments ask for.
pub fn execute(command: &Command, console: Console) -> Result<Exit, Failure> {
    match command {
        Command::Run(arguments) => run::run(arguments, console),
        Command::Check(arguments) => check::check(arguments, console),
        Command::Expect(arguments) => expect::expect(arguments, console),
        Command::Info(arguments) => info::info(arguments, console),
        Command::Render(arguments) => render::render(arguments, console),
        Command::Plot(arguments) => plot::plot(arguments, console),
        Command::Export(arguments) => export::export(arguments, console),
        Command::Recover(arguments) => recover::recover(arguments, console),
        Command::Layout(arguments) => layout::layout(arguments, console),
        Command::Bench(arguments) => bench::bench(arguments, console),
        Command::Schema => schema::schema(console),
        Command::Completions(arguments) => completions::completions(arguments, console),
        Command::Man(arguments) => manual::manual(arguments, console),
    }
}
