use super::color::{self, Rgb};
use super::options::Background;

/// The colours of everything that is not a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Theme {
    pub background: Rgb,
    pub wall_line: Rgb,
    pub wall_fill: Rgb,
    pub text: Rgb,
    pub faint_text: Rgb,
    /// Tint of the edge of a surface, and its strength.
    pub rim: (Rgb, f32),
    /// Colours of bodies that have none of their own, in turn.
    pub bodies: [Rgb; 5],
    /// Colour of a body that nothing moves.
    pub fixed_body: Rgb,
}

impl Theme {
    pub fn of(background: Background) -> Theme {
        let bodies = [[232, 163, 61], [217, 95, 89], [126, 176, 105], [163, 129, 204], [76, 169, 168]];
        match background {
            Background::Dark => Theme {
                background: [14, 19, 27],
                wall_line: [126, 140, 158],
                wall_fill: [36, 45, 57],
                text: [226, 232, 240],
                faint_text: [148, 161, 178],
                rim: ([255; 3], 0.40),
                bodies,
                fixed_body: [110, 122, 138],
            },
            Background::Light => Theme {
                background: [252, 252, 250],
                wall_line: [84, 96, 112],
                wall_fill: [221, 226, 232],
                text: [27, 34, 44],
                faint_text: [93, 104, 120],
                rim: ([10, 20, 40], 0.30),
                bodies,
                fixed_body: [150, 160, 172],
            },
        }
    }

    /// The colour itself, or one that stands out where it would sink into the background.
    pub fn visible(&self, color: Rgb) -> Rgb {
        let contrast = (color::luminance(color) - color::luminance(self.background)).abs();
        if contrast < 0.05 {
            color::mix(color, self.text, 0.5)
        } else if color::luminance(self.background) > 0.5 && contrast < 0.45 {
            color::mix(color, self.text, 0.6)
        } else {
            color
        }
    }
}
