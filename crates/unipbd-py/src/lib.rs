//! The native part of the Python package `unipbd`: what is slow in Python or only known in Rust.
//! The package around it (python/unipbd) gives it names, documentation and manners.

mod arrays;
mod body;
mod command;
mod convert;
mod diagnostics;
mod edit;
mod errors;
mod group;
mod hook;
mod live;
mod log;
mod order;
mod particles;
mod picture;
mod pool;
mod query;
mod recording;
mod scene;
mod solver;
mod state;
mod step;
mod world;
mod world_edit;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<solver::Solver>()?;
    module.add_class::<state::State>()?;
    module.add_class::<particles::Particles>()?;
    module.add_class::<hook::Substep>()?;
    module.add_class::<group::Projection>()?;
    module.add_class::<recording::Recorder>()?;
    module.add_class::<log::LogReader>()?;
    module.add_class::<pool::Pool>()?;
    module.add_class::<pool::Ticket>()?;
    module.add_function(wrap_pyfunction!(scene::parse_scene, module)?)?;
    module.add_function(wrap_pyfunction!(scene::load_scene, module)?)?;
    module.add_function(wrap_pyfunction!(scene::check_scene, module)?)?;
    module.add_function(wrap_pyfunction!(scene::scene_to_toml, module)?)?;
    module.add_function(wrap_pyfunction!(scene::scene_schema, module)?)?;
    module.add_function(wrap_pyfunction!(scene::renamed_key_hint, module)?)?;
    module.add_function(wrap_pyfunction!(scene::default_scene, module)?)?;
    module.add_function(wrap_pyfunction!(scene::estimate_scene, module)?)?;
    module.add_function(wrap_pyfunction!(query::body_roster, module)?)?;
    module.add_function(wrap_pyfunction!(query::body_poses, module)?)?;
    module.add_function(wrap_pyfunction!(query::body_velocities, module)?)?;
    module.add_function(wrap_pyfunction!(query::wake, module)?)?;
    module.add_function(wrap_pyfunction!(query::joints, module)?)?;
    module.add_function(wrap_pyfunction!(query::emitters, module)?)?;
    module.add_function(wrap_pyfunction!(query::ropes, module)?)?;
    module.add_function(wrap_pyfunction!(query::contacts, module)?)?;
    module.add_function(wrap_pyfunction!(query::watch_contacts, module)?)?;
    module.add_function(wrap_pyfunction!(query::contact_pairs, module)?)?;
    module.add_function(wrap_pyfunction!(query::take_contact_events, module)?)?;
    module.add_function(wrap_pyfunction!(query::ray_cast, module)?)?;
    module.add_function(wrap_pyfunction!(query::bodies_in, module)?)?;
    module.add_function(wrap_pyfunction!(query::nearest, module)?)?;
    module.add_function(wrap_pyfunction!(live::start_live, module)?)?;
    module.add_function(wrap_pyfunction!(live::live_viewers, module)?)?;
    module.add_function(wrap_pyfunction!(live::hold_live, module)?)?;
    module.add_function(wrap_pyfunction!(live::stop_live, module)?)?;
    module.add_function(wrap_pyfunction!(command::run_command, module)?)?;
    module.add_function(wrap_pyfunction!(command::thread_count, module)?)?;
    Ok(())
}
