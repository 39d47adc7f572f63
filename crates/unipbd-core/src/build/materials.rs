//! Materials as a run shows them.

use crate::observe::Material;
use crate::phase::Phase;
use crate::scene::{MaterialRef, Scene};

/// Colours of materials that name none, in turn within each phase.
const LIQUIDS: [[u8; 3]; 4] = [[58, 134, 222], [231, 111, 81], [42, 157, 143], [233, 196, 106]];
const GASES: [[u8; 3]; 2] = [[124, 152, 179], [179, 146, 172]];
const SMOKES: [[u8; 3]; 2] = [[232, 236, 241], [244, 190, 140]];

/// The materials of a scene, each with a colour.
pub(super) fn shown(scene: &Scene) -> Vec<Material> {
    let mut counts = [0; Phase::ALL.len()];
    let shown = |material: MaterialRef<'_>| {
        let number = &mut counts[material.phase() as usize];
        let palette: &[[u8; 3]] = match material.phase() {
            Phase::Gas => &GASES,
            Phase::Smoke => &SMOKES,
            _ => &LIQUIDS,
        };
        let default = palette[*number % palette.len()];
        *number += 1;
        Material {
            name: material.name().to_owned(),
            phase: material.phase(),
            density: material.density(),
            color: material.color().and_then(parse_color).unwrap_or(default),
        }
    };
    scene.materials().map(shown).collect()
}

/// `"#rrggbb"` as red, green, blue.
fn parse_color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let value = u32::from_str_radix(digits, 16).ok()?;
    let [_, red, green, blue] = value.to_be_bytes();
    Some([red, green, blue])
}
