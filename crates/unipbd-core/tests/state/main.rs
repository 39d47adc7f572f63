//! Saving, restoring, editing, hooks, and constraints of one's own.

mod bytes;
mod custom;
mod edit;
mod hook;
mod restore;
mod scenes;
