//! The functions of the module. `web/unipbd.js` is their only caller: it allocates what it passes and passes what it
//! was given.
//!
//! Safety of the whole file: text lies in memory that [`unipbd_allocate`] gave and the caller filled, and sessions are
//! those of [`unipbd_open`] that were not closed. There is one thread.
#![allow(unsafe_code)]

use std::cell::RefCell;
use std::slice;

use serde_json::{Value, json};
use unipbd_core::Vector64;
use unipbd_core::simd::Level;

use crate::{Changed, Column, Session};

thread_local! {
    /// The last answer in words.
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

fn answer(value: &Value) {
    ANSWER.with_borrow_mut(|answer| *answer = value.to_string());
}

/// The value, or what `failed` makes of an error, which is the answer then.
fn or_answer<T>(result: Result<T, Value>, failed: T) -> T {
    result.unwrap_or_else(|error| {
        answer(&error);
        failed
    })
}

/// # Safety
/// As for the whole file.
unsafe fn text<'a>(place: *const u8, bytes: usize) -> &'a str {
    // SAFETY: the caller filled this memory.
    std::str::from_utf8(unsafe { slice::from_raw_parts(place, bytes) }).unwrap_or_default()
}

/// # Safety
/// As for the whole file.
unsafe fn session<'a>(session: *mut Session) -> &'a mut Session {
    // SAFETY: it is open, and no other call has it.
    unsafe { &mut *session }
}

/// Memory for text.
#[unsafe(no_mangle)]
pub extern "C" fn unipbd_allocate(bytes: usize) -> *mut u8 {
    Box::leak(vec![0; bytes].into_boxed_slice()).as_mut_ptr()
}

/// Gives memory back.
///
/// # Safety
/// It is from `unipbd_allocate`, with this number of bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_free(place: *mut u8, bytes: usize) {
    // SAFETY: it was a boxed slice of this length.
    drop(unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(place, bytes)) });
}

/// Where the last answer is, JSON in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn unipbd_answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// Bytes of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn unipbd_answer_bytes() -> usize {
    ANSWER.with_borrow(String::len)
}

/// Answers with version, instruction set and the JSON schema of scenes.
#[unsafe(no_mangle)]
pub extern "C" fn unipbd_about() {
    let simd = Level::best().name();
    answer(&json!({ "version": env!("CARGO_PKG_VERSION"), "simd": simd, "schema": unipbd_scene_file::schema() }));
}

/// Opens a scene with overrides, one a line. Null where it has mistakes, which are the answer.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_open(
    scene: *const u8,
    scene_bytes: usize,
    settings: *const u8,
    settings_bytes: usize,
) -> *mut Session {
    // SAFETY: passed on to the caller.
    let (scene, settings) = unsafe { (text(scene, scene_bytes), text(settings, settings_bytes)) };
    let opened = Session::new(scene, settings).map(|session| Box::into_raw(Box::new(session)));
    or_answer(opened, std::ptr::null_mut())
}

/// Closes a session.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_close(session: *mut Session) {
    // SAFETY: it came out of a box, and is not used again.
    drop(unsafe { Box::from_raw(session) });
}

/// Replaces the overrides: 1 where the run goes on, 0 where it starts anew, -1 with an answer where it cannot be.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_change(run: *mut Session, settings: *const u8, settings_bytes: usize) -> i32 {
    // SAFETY: passed on to the caller.
    let changed = unsafe { session(run).change(text(settings, settings_bytes)) };
    or_answer(changed.map(|changed| i32::from(changed == Changed::Continued)), -1)
}

/// Advances by a frame: its substeps, or -1 with an answer.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_step(run: *mut Session) -> i32 {
    // SAFETY: passed on to the caller.
    let stepped = unsafe { session(run).step() };
    or_answer(stepped.map(|substeps| substeps as i32), -1)
}

/// Frames done.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_frame(run: *mut Session) -> u32 {
    // SAFETY: passed on to the caller.
    unsafe { session(run).solver.frame() as u32 }
}

/// Simulated time \[s].
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_time(run: *mut Session) -> f64 {
    // SAFETY: passed on to the caller.
    unsafe { session(run).solver.time() }
}

/// Hash of the state.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_hash(run: *mut Session) -> u64 {
    // SAFETY: passed on to the caller.
    unsafe { session(run).hash() }
}

/// Answers with what stays the same over the run.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_describe(run: *mut Session) {
    // SAFETY: passed on to the caller.
    answer(&unsafe { session(run).describe() });
}

/// Answers with the diagnostics.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_diagnostics(run: *mut Session) {
    // SAFETY: passed on to the caller.
    answer(&unsafe { session(run).diagnostics() });
}

/// Where the column of this number lies.
///
/// # Safety
/// As for the whole file; there is a column of this number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_column(run: *mut Session, column: usize) -> *const u8 {
    // SAFETY: passed on to the caller.
    unsafe { session(run).column(Column::ALL[column]).place() }
}

/// Numbers in the column of this number.
///
/// # Safety
/// As for the whole file; there is a column of this number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_column_length(run: *mut Session, column: usize) -> usize {
    // SAFETY: passed on to the caller.
    unsafe { session(run).column(Column::ALL[column]).len() }
}

/// Fills the free places of a disc \[m]: the number of particles, or -1 with an answer.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_pour(run: *mut Session, material: usize, x: f64, y: f64, radius: f64) -> i32 {
    // SAFETY: passed on to the caller.
    let poured = unsafe { session(run).pour(material, Vector64::new(x, y), radius) };
    or_answer(poured.map(|count| count as i32), -1)
}

/// Takes hold of the body at a point \[m]: its number, or -1.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_grab(run: *mut Session, x: f64, y: f64) -> i32 {
    // SAFETY: passed on to the caller.
    unsafe { session(run).grab(Vector64::new(x, y)) }.map_or(-1, |body| body as i32)
}

/// Moves the hand to a point \[m].
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_drag(run: *mut Session, x: f64, y: f64) {
    // SAFETY: passed on to the caller.
    unsafe { session(run).drag(Vector64::new(x, y)) };
}

/// Lets go.
///
/// # Safety
/// As for the whole file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn unipbd_release(run: *mut Session) {
    // SAFETY: passed on to the caller.
    unsafe { session(run).release() };
}
