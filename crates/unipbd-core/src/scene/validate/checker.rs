use std::collections::HashMap;

use crate::scene::{KeyPath, MaterialRef, Problems, Scene};

/// Collects the problems of one scene.
pub(super) struct Checker<'a> {
    pub(super) scene: &'a Scene,
    pub(super) problems: Problems,
    /// The spacing, unless it is at fault itself \[m].
    pub(super) spacing: Option<f64>,
    /// The first material of each name, by index.
    pub(super) materials: HashMap<&'a str, MaterialRef<'a>>,
    /// Whether particle counts and coordinates are within bounds, so that shapes may be compared.
    pub(super) size_is_sane: bool,
}

/// The values a number may have.
#[derive(Clone, Copy)]
pub(super) enum Allowed {
    /// Above 0.
    Positive,
    /// 0 or above.
    NotNegative,
    /// From the first to the second, both included.
    Between(f64, f64),
}

impl Allowed {
    fn contains(self, value: f64) -> bool {
        match self {
            Allowed::Positive => value > 0.0,
            Allowed::NotNegative => value >= 0.0,
            Allowed::Between(least, most) => value >= least && value <= most,
        }
    }

    fn describe(self) -> String {
        match self {
            Allowed::Positive => "must be greater than 0".to_owned(),
            Allowed::NotNegative => "must not be negative".to_owned(),
            Allowed::Between(least, most) => format!("must be from {} to {}", number(least), number(most)),
        }
    }
}

impl<'a> Checker<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let sane = scene.spacing > 0.0 && scene.spacing.is_finite();
        let spacing = sane.then_some(scene.spacing);
        let mut materials = HashMap::new();
        for material in scene.materials() {
            materials.entry(material.name()).or_insert(material);
        }
        Checker { scene, problems: Problems::default(), spacing, materials, size_is_sane: false }
    }

    /// Notes a problem.
    pub(super) fn problem(&mut self, path: KeyPath, message: impl Into<String>, hint: impl Into<String>) {
        self.problems.add_with_hint(path, message, hint);
    }

    /// Notes a number outside its range and says whether it is fine, as one that is left out is. Numbers that are
    /// not finite are noted elsewhere.
    pub(super) fn range(&mut self, path: KeyPath, value: impl Into<Option<f64>>, allowed: Allowed, hint: &str) -> bool {
        let Some(value) = value.into() else { return true };
        if !value.is_finite() {
            return false;
        }
        if allowed.contains(value) {
            return true;
        }
        self.problem(path, format!("{}, found {}", allowed.describe(), number(value)), hint);
        false
    }

    /// Notes a length below one spacing (which is too thin to hold a particle).
    pub(super) fn at_least_one_spacing(&mut self, path: KeyPath, length: f64, what: &str) {
        let Some(spacing) = self.spacing else { return };
        if length < spacing * (1.0 - 1e-6) {
            let message = format!("{what} is {} m, less than one spacing ({} m)", number(length), number(spacing));
            self.problem(path, message, "make it at least one spacing, or lower `spacing`");
        }
    }

    /// Notes a vector without a direction.
    pub(super) fn direction(&mut self, path: KeyPath, vector: [f64; 2], hint: &str) {
        if vector == [0.0, 0.0] {
            self.problem(path, "must not be the zero vector", hint);
        }
    }

    /// Notes a lower left corner that is not below and left of the upper right one.
    pub(super) fn corners(&mut self, path: &KeyPath, min: [f64; 2], max: [f64; 2]) -> bool {
        self.corners_named(path, min, max, ["min", "max"])
    }

    /// Like [`Checker::corners`] where the keys have other names.
    pub(super) fn corners_named(&mut self, path: &KeyPath, min: [f64; 2], max: [f64; 2], keys: [&str; 2]) -> bool {
        let axis = ["x", "y"].into_iter().zip(min.into_iter().zip(max)).find(|(_, (min, max))| min >= max);
        if let Some((axis, (least, most))) = axis {
            let [min, max] = keys;
            let message =
                format!("must lie above and right of `{min}`: in {axis}, {} to {}", number(least), number(most));
            let hint = format!("`{min}` is the lower left corner, `{max}` the upper right one");
            self.problem(path.then(max), message, hint);
        }
        axis.is_none()
    }
}

/// The tables of an array with their paths.
pub(super) fn entries<'s, T>(
    array: &'static str,
    tables: &'s [T],
) -> impl Iterator<Item = (KeyPath, &'s T)> + use<'s, T> {
    tables.iter().enumerate().map(move |(index, table)| (KeyPath::entry(array, index), table))
}

/// A number as one would write it: no rounding noise, no rows of zeros.
pub(super) fn number(value: f64) -> String {
    let value = format!("{value:.11e}").parse().unwrap_or(value);
    let size = f64::abs(value);
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{value:e}") } else { format!("{value}") }
}

/// A computed length, rounded to three digits.
pub(super) fn rounded(value: f64) -> String {
    let text = format!("{value:.2e}");
    text.parse().map_or(text, number)
}
