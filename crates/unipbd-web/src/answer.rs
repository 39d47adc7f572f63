//! Answers to a page, as JSON.

use serde_json::{Map, Value, json};
use unipbd_core::observe::{Quantity, Value as Measured};
use unipbd_scene_file::{Diagnostic, SceneFileError};

/// The mistakes of a scene: the whole text as a terminal shows it, and each with its place.
pub fn mistakes(error: &SceneFileError) -> Value {
    let problems: Vec<Value> = error.problems().iter().map(problem).collect();
    json!({ "text": error.to_string(), "problems": problems })
}

/// Something that went wrong and has no place in the text.
pub fn failure(message: &str) -> Value {
    json!({ "text": message, "problems": [] })
}

fn problem(problem: &Diagnostic) -> Value {
    json!({
        "line": problem.line,
        "column": problem.column,
        "length": problem.caret.len().max(1),
        "key": problem.key,
        "message": problem.message,
        "hint": problem.hint,
    })
}

/// A table of quantities under the names of its columns.
pub fn table<T: Default>(of: &T, quantities: &[Quantity<T>]) -> Value {
    let columns =
        quantities.iter().flat_map(|quantity| quantity.columns().into_iter().zip((quantity.read)(of).columns()));
    Value::Object(columns.map(|(name, value)| (name, number(value))).collect::<Map<String, Value>>())
}

fn number(value: Measured<'_>) -> Value {
    match value {
        Measured::Count(count) => count.into(),
        Measured::Number(number) => number.into(),
        Measured::Word(word) => word.into(),
        // These have columns of their own.
        Measured::Vector(_) | Measured::ByPhase(_) => Value::Null,
    }
}
