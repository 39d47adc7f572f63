//! Keys of earlier versions of the format: each is refused with a hint that names its successors.

/// A key that the format no longer has.
pub(super) struct Renamed {
    /// Path of the old key, without the numbers of tables; with `=` a word that the key no longer takes.
    old: &'static str,
    /// Paths of the keys that took its place.
    new: &'static [&'static str],
    /// Why it went, or how its successors differ.
    reason: &'static str,
}

const TWO_VISCOSITIES: &str =
    "the first is the smoothing per substep that `viscosity` was, the second a physical viscosity [m^2/s]";

const FOR_COMPARISON: &str = "the table holds what is there for comparison alone";

const RENAMED: &[Renamed] = &[
    Renamed {
        old: "liquid.cohesion",
        new: &["liquid.surface_tension"],
        reason: "it is a force in N, 0.0728 for water",
    },
    Renamed {
        old: "liquid.adhesion",
        new: &["liquid.contact_angle"],
        reason: "the angle at walls in degrees, beside a surface tension",
    },
    Renamed { old: "liquid.viscosity", new: &["liquid.xsph", "liquid.kinematic_viscosity"], reason: TWO_VISCOSITIES },
    Renamed {
        old: "solver.preset",
        new: &["legacy"],
        reason: "the settings of the preset are written out in scenes/seed",
    },
    Renamed { old: "solver.kernel", new: &["legacy.kernel"], reason: FOR_COMPARISON },
    Renamed { old: "solver.constraint_mixing", new: &["legacy.constraint_mixing"], reason: FOR_COMPARISON },
    Renamed { old: "solver.artificial_pressure", new: &["legacy.artificial_pressure"], reason: FOR_COMPARISON },
    Renamed { old: "solver.mass_density", new: &["legacy.mass_density"], reason: FOR_COMPARISON },
    Renamed { old: "solver.gradients=middle", new: &[], reason: "write \"early\": waves lose less with it" },
    Renamed {
        old: "contacts.method=averaged",
        new: &["legacy.averaged_contacts"],
        reason: "it holds the over-relaxation",
    },
    Renamed { old: "contacts.method=split", new: &[], reason: "write \"split_jacobi\"" },
    Renamed {
        old: "solver.coarse_projection",
        new: &["solver.pressure_grid"],
        reason: "\"on\", \"off\" or \"auto\" in place of a number of steps",
    },
    Renamed {
        old: "body.stiffness",
        new: &["body.compliance"],
        reason: "it is in m/N, 0 is rigid, and gives the same shape at every number of substeps",
    },
    Renamed { old: "points.motion=scripted", new: &[], reason: "write \"kinematic\"" },
    Renamed { old: "contacts.mass_scaling", new: &["legacy.mass_scaling"], reason: FOR_COMPARISON },
    Renamed { old: "gas.viscosity", new: &["gas.xsph", "gas.kinematic_viscosity"], reason: TWO_VISCOSITIES },
];

/// The entry of an old key, named by its path or by its last word alone.
pub(super) fn find(key: &str) -> Option<&'static Renamed> {
    RENAMED.iter().find(|entry| entry.old == key || last(entry.old) == key)
}

/// The hint for an old key, named by its path or by its last word alone.
pub fn renamed_key_hint(key: &str) -> Option<String> {
    find(key).map(Renamed::hint)
}

impl Renamed {
    /// The only successor, where it stands in the same table.
    pub(super) fn successor(&self) -> Option<&'static str> {
        match self.new {
            [only] if table(only) == table(self.old) => Some(last(only)),
            _ => None,
        }
    }

    pub(super) fn hint(&self) -> String {
        let name = |new: &&'static str| if table(new) == table(self.old) { last(new) } else { new };
        let names: Vec<String> = self.new.iter().map(|new| format!("`{}`", name(new))).collect();
        match names.as_slice() {
            [] => self.reason.to_owned(),
            names => format!("write {}: {}", names.join(" or "), self.reason),
        }
    }
}

/// The last word of a path.
fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// The path of the table that holds a key.
fn table(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(table, _)| table)
}

#[cfg(test)]
mod tests {
    use super::super::schema::{self, Kind};
    use super::*;

    fn exists(path: &str) -> bool {
        let root = schema::schema();
        let mut place = &root;
        path.split('.').all(|word| {
            let inner = match schema::kind(&root, place) {
                Kind::Array(array) => array.element(0),
                _ => place,
            };
            let Kind::Table(table) = schema::kind(&root, inner) else { return false };
            let found = table.key(word);
            place = found.unwrap_or(place);
            found.is_some()
        })
    }

    #[test]
    fn old_keys_are_gone_and_their_successors_exist() {
        assert!(exists("liquid.density") && exists("solver.substeps"));
        for entry in RENAMED {
            assert!(!exists(entry.old), "{} is still a key", entry.old);
            for new in entry.new {
                assert!(exists(new), "{new} is no key");
            }
        }
    }

    #[test]
    fn a_successor_in_the_same_table_is_named_by_its_key() {
        let moved = Renamed { old: "solver.mixing", new: &["seed.mixing"], reason: "it moved" };
        assert_eq!(moved.hint(), "write `seed.mixing`: it moved");
        assert_eq!(moved.successor(), None);
        assert!(renamed_key_hint("viscosity").is_some_and(|hint| hint.starts_with("write `xsph` or `kinematic")));
        assert!(renamed_key_hint("xsph").is_none());
    }
}
