//! Conditions on the diagnostics that end a run.

use std::fmt;
use std::str::FromStr;

use unipbd_core::observe::Diagnostics;
use unipbd_core::phase::Phase;
use unipbd_core::scene::nearest;

type Quantity = fn(&Diagnostics) -> f64;

/// The numbers that a condition may name: the diagnostics, and short names for the usual ones.
const QUANTITIES: &[(&str, Quantity)] = &[
    ("density_error", |d| d.density_error_max),
    ("speed", |d| d.speed_max),
    ("energy", |d| d.kinetic_energy + d.potential_energy),
    ("time", |d| d.time),
    ("frame", |d| d.frame as f64),
    ("step", |d| d.step as f64),
    ("substeps", |d| f64::from(d.substeps)),
    ("substeps_wanted", |d| f64::from(d.substeps_wanted)),
    ("contact_penetration", |d| d.contact_penetration),
    ("iterations", |d| f64::from(d.iterations)),
    ("list_builds", |d| f64::from(d.list_builds)),
    ("particles", |d| d.particles() as f64),
    ("liquid", |d| d.count(Phase::Liquid) as f64),
    ("gas", |d| d.count(Phase::Gas) as f64),
    ("smoke", |d| d.count(Phase::Smoke) as f64),
    ("rigid", |d| d.count(Phase::Rigid) as f64),
    ("solid", |d| d.count(Phase::Solid) as f64),
    ("density_error_mean", |d| d.density_error_mean),
    ("density_error_max", |d| d.density_error_max),
    ("density_error_min", |d| d.density_error_min),
    ("pressure_max", |d| d.pressure_max),
    ("kinetic_energy", |d| d.kinetic_energy),
    ("potential_energy", |d| d.potential_energy),
    ("angular_momentum", |d| d.angular_momentum),
    ("speed_max", |d| d.speed_max),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Above,
    Below,
}

/// A condition such as `density_error>0.05`.
#[derive(Clone, Copy, Debug)]
pub struct StopCondition {
    name: &'static str,
    quantity: Quantity,
    comparison: Comparison,
    threshold: f64,
}

impl StopCondition {
    /// The value that meets the condition, if it is met.
    pub fn met_by(&self, diagnostics: &Diagnostics) -> Option<f64> {
        let value = (self.quantity)(diagnostics);
        let met = match self.comparison {
            Comparison::Above => value > self.threshold,
            Comparison::Below => value < self.threshold,
        };
        met.then_some(value)
    }
}

impl fmt::Display for StopCondition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match self.comparison {
            Comparison::Above => '>',
            Comparison::Below => '<',
        };
        write!(f, "{}{sign}{}", self.name, self.threshold)
    }
}

impl FromStr for StopCondition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let place = text.find(['<', '>']).ok_or("expected a quantity, < or >, and a number: density_error>0.05")?;
        let (name, rest) = (text[..place].trim(), &text[place + 1..]);
        let comparison = if text[place..].starts_with('<') { Comparison::Below } else { Comparison::Above };
        let &(name, quantity) =
            QUANTITIES.iter().find(|(known, _)| *known == name).ok_or_else(|| unknown_quantity(name))?;
        let threshold: f64 = rest.trim().parse().map_err(|_| format!("\"{}\" is not a number", rest.trim()))?;
        if threshold.is_nan() {
            return Err("nothing is larger or smaller than NaN".into());
        }
        Ok(StopCondition { name, quantity, comparison, threshold })
    }
}

fn unknown_quantity(name: &str) -> String {
    let names: Vec<&str> = QUANTITIES.iter().map(|(known, _)| *known).collect();
    let suggestion = nearest(name, names.iter().copied());
    let suggestion = suggestion.map_or(";".to_owned(), |known| format!("; did you mean \"{known}\"?"));
    format!("unknown quantity \"{name}\"{suggestion} known are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use unipbd_core::math::Vector64;

    fn diagnostics() -> Diagnostics {
        Diagnostics {
            time: 1.5,
            frame: 90,
            step: 720,
            substeps: 8,
            iterations: 8,
            list_builds: 2,
            count_by_phase: [800, 0, 0, 0, 0],
            density_error_mean: 0.002,
            density_error_max: 0.06,
            density_error_min: -0.4,
            pressure_max: 40.0,
            kinetic_energy: 5.0,
            potential_energy: 7.0,
            momentum: Vector64::ZERO,
            angular_momentum: 0.0,
            speed_max: 3.0,
            materials: Vec::new(),
            groups: Vec::new(),
            ..Diagnostics::default()
        }
    }

    #[test]
    fn conditions_hold_when_the_quantity_passes_the_threshold() {
        let met = |text: &str| text.parse::<StopCondition>().unwrap().met_by(&diagnostics());
        assert_eq!(met("density_error>0.05"), Some(0.06));
        assert_eq!(met("density_error > 0.06"), None);
        assert_eq!(met("energy<12.5"), Some(12.0));
        assert_eq!(met("speed>2"), Some(3.0));
        assert_eq!(met("gas<1"), Some(0.0));
        assert_eq!(met("density_error_min<-0.5"), None);
    }

    #[test]
    fn malformed_conditions_say_what_is_expected() {
        let refused = |text: &str| text.parse::<StopCondition>().unwrap_err();
        assert!(refused("density_error").contains("density_error>0.05"));
        assert!(refused("densty_error>1").contains("did you mean \"density_error\""));
        assert!(refused("speed>fast").contains("\"fast\" is not a number"));
        assert!(refused("speed>NaN").contains("NaN"));
    }
}
