//! Options of Macklin & Müller 2013, of Macklin et al. 2014 and of the program that this project grew from: groups and
//! a contact solver of their own, which the builder takes where the `[legacy]` table of a scene asks for them. No
//! other module depends on them.

mod contacts;
mod density;
mod kernels;
mod mass_density;
mod mass_scaling;

pub use contacts::contacts;
pub use density::LegacyDensity;
pub use kernels::Formula;
pub use mass_density::MassDensity;
