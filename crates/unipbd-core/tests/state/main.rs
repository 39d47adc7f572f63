//! Saving, restoring, editing, hooks, and constraints of one's own.

mod budget;
mod bytes;
mod custom;
mod edit;
mod emitters;
mod first_body;
mod hook;
mod restore;
mod scenes;
