//! The options of the `[legacy]` table, and what they have no use for.

use super::checker::{Allowed, Checker};
use crate::scene::{ContactDescription, GradientPoint, KeyPath, MassDensityDescription};

pub(super) fn check(checker: &mut Checker) {
    let legacy = &checker.scene.legacy;
    let path = |key| KeyPath::key("legacy").then(key);
    let off = "the default is 0";
    checker.range(path("constraint_mixing"), legacy.constraint_mixing, Allowed::Between(0.0, 10.0), off);
    checker.range(path("artificial_pressure"), legacy.artificial_pressure, Allowed::Between(0.0, 1.0), off);
    let hint = "in 1/m: with 1, a body a metre up weighs 1/e of itself on the one below; 0 is off";
    checker.range(path("mass_scaling"), legacy.mass_scaling, Allowed::NotNegative, hint);
    if let Some(relaxation) = legacy.averaged_contacts {
        let hint = "the over-relaxation: 1 is plain, 2 the most that can be stable";
        checker.range(path("averaged_contacts"), relaxation, Allowed::Between(1.0, 2.0), hint);
        if checker.scene.contacts.relaxation != ContactDescription::default().relaxation {
            let key = KeyPath::key("contacts").then("relaxation");
            checker.problem(key, "has no effect on averaged contacts", "legacy.averaged_contacts takes its place");
        }
    }
    if let Some(description) = &legacy.mass_density {
        check_mass_density(checker, description);
    }
}

fn check_mass_density(checker: &mut Checker, description: &MassDensityDescription) {
    let (scene, table) = (checker.scene, KeyPath::key("legacy").then("mass_density"));
    let least = Allowed::NotNegative;
    checker.range(table.then("liquid_mixing"), description.liquid_mixing, least, "the default is 0.01");
    checker.range(table.then("gas_mixing"), description.gas_mixing, least, "the default is 0.05");
    checker.range(table.then("artificial_pressure"), description.artificial_pressure, least, "the default is 0.1");
    let (part, hint) = (Allowed::Between(0.0, 0.9), "a part of the kernel radius");
    checker.range(table.then("liquid_reference"), description.liquid_reference, part, hint);
    checker.range(table.then("gas_reference"), description.gas_reference, part, hint);
    if scene.gradients() != GradientPoint::Predicted {
        let message = "a density weighted with masses takes its gradients at the predicted positions";
        checker.problem(table, message, "write gradients = \"predicted\" in the table [solver]");
    }
    let unused = [
        ("solver", "shifting", scene.solver.shifting.is_some()),
        ("legacy", "constraint_mixing", scene.legacy.constraint_mixing != 0.0),
        ("legacy", "artificial_pressure", scene.legacy.artificial_pressure != 0.0),
    ];
    for (table, key, _) in unused.into_iter().filter(|(.., given)| *given) {
        let hint = "leave it out; legacy.mass_density has keys of its own";
        checker.problem(KeyPath::key(table).then(key), "has no effect on a density weighted with masses", hint);
    }
}
