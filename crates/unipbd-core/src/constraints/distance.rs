use super::Constraint;
use crate::math::{Real, Vector};

/// Two particles keep their distance: C = |x_1 - x_2| - d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Ids of the particles.
    pub particles: [u32; 2],
    /// Distance d \[m].
    pub length: Real,
    /// Inverse stiffness, 0 is rigid [m/N].
    pub compliance: Real,
}

/// Two particles never come farther apart than a length: C = d - |x_1 - x_2| >= 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// Ids of the particles.
    pub particles: [u32; 2],
    /// Largest distance d \[m].
    pub length: Real,
    /// Inverse stiffness, 0 is rigid [m/N].
    pub compliance: Real,
}

/// Distance of two points and the unit vector from the second to the first.
fn apart([a, b]: [Vector; 2]) -> Option<(Real, Vector)> {
    let length = (a - b).length();
    (length > 0.0).then(|| (length, (a - b) / length))
}

impl Constraint<2> for Distance {
    const NAME: &'static str = "distances";

    fn particles(&self) -> [u32; 2] {
        self.particles
    }

    fn compliance(&self) -> Real {
        self.compliance
    }

    fn evaluate(&self, positions: [Vector; 2]) -> Option<(Real, [Vector; 2])> {
        let (length, direction) = apart(positions)?;
        Some((length - self.length, [direction, -direction]))
    }
}

impl Constraint<2> for Tether {
    const NAME: &'static str = "tethers";
    const INEQUALITY: bool = true;

    fn particles(&self) -> [u32; 2] {
        self.particles
    }

    fn compliance(&self) -> Real {
        self.compliance
    }

    fn evaluate(&self, positions: [Vector; 2]) -> Option<(Real, [Vector; 2])> {
        let (length, direction) = apart(positions)?;
        Some((self.length - length, [-direction, direction]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_is_violated_both_ways_and_a_tether_only_when_taut() {
        let at = |x: Real| [Vector::new(x, 0.0), Vector::ZERO];
        let distance = Distance { particles: [0, 1], length: 1.0, compliance: 0.0 };
        let tether = Tether { particles: [0, 1], length: 1.0, compliance: 0.0 };
        assert_eq!(distance.evaluate(at(1.5)), Some((0.5, [Vector::X, -Vector::X])));
        assert_eq!(distance.evaluate(at(0.5)).map(|(value, _)| value), Some(-0.5));
        assert!(tether.evaluate(at(1.5)).is_some_and(|(value, _)| value < 0.0), "taut");
        assert!(tether.evaluate(at(0.5)).is_some_and(|(value, _)| value > 0.0), "slack");
        assert_eq!(distance.evaluate(at(0.0)), None);
    }
}
