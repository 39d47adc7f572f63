//! Conditions on the diagnostics that end a run.

use std::fmt;
use std::str::FromStr;
use std::sync::LazyLock;

use unipbd_core::observe::{Diagnostics, Quantity, Table};
use unipbd_core::phase::Phase;
use unipbd_core::scene::{Gauge, nearest};

/// A number that a condition may name: a column of a quantity.
#[derive(Debug)]
struct Column {
    name: String,
    quantity: &'static Quantity<Diagnostics>,
    index: usize,
}

/// Short names for the usual columns; a phase stands for the number of its particles.
const SHORT_NAMES: [(&str, &str); 2] = [("density_error", "density_error_max"), ("speed", "speed_max")];

/// Short names, then every number of the diagnostics.
static COLUMNS: LazyLock<Vec<Column>> = LazyLock::new(|| {
    let mut columns: Vec<Column> = short_names().filter_map(|(short, name)| column(&short, &name)).collect();
    let names = Diagnostics::QUANTITIES.iter().flat_map(Quantity::columns);
    columns.extend(names.filter_map(|name| column(&name, &name)));
    columns
});

fn short_names() -> impl Iterator<Item = (String, String)> {
    let short = SHORT_NAMES.into_iter().map(|(short, name)| (short.to_owned(), name.to_owned()));
    short.chain(Phase::ALL.map(|phase| (phase.name().to_owned(), format!("count_{}", phase.name()))))
}

/// The column of this name, to be known by another; `None` where it is no number.
fn column(known_as: &str, name: &str) -> Option<Column> {
    Diagnostics::QUANTITIES.iter().find_map(|quantity| {
        let index = quantity.columns().iter().position(|column| column == name)?;
        let column = Column { name: known_as.to_owned(), quantity, index };
        column.read(&Diagnostics::default()).map(|_| column)
    })
}

impl Column {
    fn read(&self, diagnostics: &Diagnostics) -> Option<f64> {
        (self.quantity.read)(diagnostics).columns().get(self.index).and_then(|value| value.number())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Above,
    Below,
}

/// How the reading of a gauge is named.
const GAUGE: &str = "gauge.";

/// Subject of a condition.
#[derive(Clone, Debug)]
enum Subject {
    Column(&'static Column),
    /// The gauge of this name; whether there is one, the scene tells.
    Gauge(String),
}

impl Subject {
    fn parse(name: &str) -> Result<Self, String> {
        if let Some(gauge) = name.strip_prefix(GAUGE) {
            return Ok(Subject::Gauge(gauge.to_owned()));
        }
        COLUMNS.iter().find(|column| column.name == name).map(Subject::Column).ok_or_else(|| unknown_quantity(name))
    }

    fn read(&self, diagnostics: &Diagnostics) -> Option<f64> {
        match self {
            Subject::Column(column) => column.read(diagnostics),
            Subject::Gauge(name) => {
                let gauge = diagnostics.gauges.iter().find(|gauge| gauge.name == *name)?;
                // A gauge with nothing to read meets no condition.
                Some(gauge.value).filter(|value| !value.is_nan())
            }
        }
    }
}

/// A condition such as `density_error>0.05`.
#[derive(Clone, Debug)]
pub struct StopCondition {
    subject: Subject,
    comparison: Comparison,
    threshold: f64,
}

impl StopCondition {
    /// Refuses a gauge that is none of these.
    pub fn check(&self, gauges: &[Gauge]) -> Result<(), String> {
        let Subject::Gauge(name) = &self.subject else { return Ok(()) };
        let names = || gauges.iter().map(|gauge| gauge.name.as_str());
        if names().any(|known| known == name) {
            return Ok(());
        }
        let hint = match nearest(name, names()) {
            Some(known) => format!("did you mean \"{GAUGE}{known}\"?"),
            None if gauges.is_empty() => "the scene has no [[gauge]]".to_owned(),
            None => format!("its gauges are {}", names().take(8).collect::<Vec<_>>().join(", ")),
        };
        Err(format!("--stop-on {self}: the scene has no gauge \"{name}\"; {hint}"))
    }

    /// The value that meets the condition, if it is met.
    pub fn met_by(&self, diagnostics: &Diagnostics) -> Option<f64> {
        let value = self.subject.read(diagnostics)?;
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
        match &self.subject {
            Subject::Column(column) => write!(f, "{}{sign}{}", column.name, self.threshold),
            Subject::Gauge(name) => write!(f, "{GAUGE}{name}{sign}{}", self.threshold),
        }
    }
}

impl FromStr for StopCondition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let place = text.find(['<', '>']).ok_or("expected a quantity, < or >, and a number: density_error>0.05")?;
        let (name, rest) = (text[..place].trim(), &text[place + 1..]);
        let comparison = if text[place..].starts_with('<') { Comparison::Below } else { Comparison::Above };
        let subject = Subject::parse(name)?;
        let threshold: f64 = rest.trim().parse().map_err(|_| format!("\"{}\" is not a number", rest.trim()))?;
        if threshold.is_nan() {
            return Err("nothing is larger or smaller than NaN".into());
        }
        Ok(StopCondition { subject, comparison, threshold })
    }
}

fn unknown_quantity(name: &str) -> String {
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name.as_str()).collect();
    let suggestion = nearest(name, names.iter().copied());
    let suggestion = suggestion.map_or(";".to_owned(), |known| format!("; did you mean \"{known}\"?"));
    format!("unknown quantity \"{name}\"{suggestion} known are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use unipbd_core::math::Vector64;
    use unipbd_core::observe::GaugeReading;
    use unipbd_core::scene::GaugeKind;

    fn reading(name: &str, value: f64) -> GaugeReading {
        GaugeReading { name: name.to_owned(), value, kind: GaugeKind::Level }
    }

    fn diagnostics() -> Diagnostics {
        Diagnostics {
            counts: [800, 0, 0, 0, 0],
            density_error_max: 0.06,
            density_error_min: -0.4,
            kinetic_energy: 5.0,
            potential_energy: 7.0,
            momentum: Vector64::new(1.0, -2.0),
            speed_max: 3.0,
            gauges: [("level", 0.5), ("dry", f64::NAN)].map(|(name, value)| reading(name, value)).to_vec(),
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
        assert_eq!(met("liquid>1"), met("count_liquid>1"));
        assert_eq!(met("particles>1"), Some(800.0));
        assert_eq!(met("momentum_y<-1"), Some(-2.0));
        assert_eq!(met("density_error_min<-0.5"), None);
        assert_eq!(met("gauge.level > 0.4"), Some(0.5));
        assert_eq!((met("gauge.level<0.4"), met("gauge.dry<1"), met("gauge.dry>-1")), (None, None, None));
    }

    #[test]
    fn every_number_of_the_diagnostics_can_be_named() {
        let mut words = Vec::new();
        for quantity in Diagnostics::QUANTITIES {
            for (name, value) in quantity.columns().iter().zip((quantity.read)(&diagnostics()).columns()) {
                match (format!("{name}>-1e9").parse::<StopCondition>(), value.number()) {
                    (Ok(condition), Some(number)) => assert_eq!(condition.met_by(&diagnostics()), Some(number)),
                    (Err(_), None) => words.push(name.clone()),
                    (parsed, _) => panic!("{name}: {parsed:?}"),
                }
            }
        }
        assert_eq!(words, ["substeps_reason"]);
    }

    #[test]
    fn a_gauge_that_the_scene_lacks_is_named_with_the_one_that_is_meant() {
        let condition: StopCondition = "gauge.levl>1".parse().unwrap();
        let message = condition.check(&[Gauge::new("level", GaugeKind::Level)]).unwrap_err();
        assert!(message.contains("no gauge \"levl\"; did you mean \"gauge.level\"?"), "{message}");
        assert!(condition.check(&[]).unwrap_err().contains("the scene has no [[gauge]]"));
        assert!(condition.check(&[Gauge::new("levl", GaugeKind::Level)]).is_ok());
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
