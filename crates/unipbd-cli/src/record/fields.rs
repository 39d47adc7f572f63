use std::fmt;
use std::str::FromStr;

/// Particle columns a log holds besides position and colour. Each makes the log larger; velocity
/// alone doubles it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fields {
    /// Velocities [m/s].
    pub velocity: bool,
    /// Density errors C = rho/rho0 - 1, as fractions.
    pub density: bool,
    /// Temperatures.
    pub temperature: bool,
    /// The samples of bodies, as a topic of their own.
    pub samples: bool,
}

impl Fields {
    /// Every column.
    pub const ALL: Fields = Fields { velocity: true, density: true, temperature: true, samples: false };

    /// Whether any column is asked for.
    pub fn any(self) -> bool {
        self.velocity || self.density || self.temperature
    }
}

/// A word that names no field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownField(pub String);

impl fmt::Display for UnknownField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown field \"{}\": expected velocity, density, temperature, samples or all", self.0)
    }
}

impl std::error::Error for UnknownField {}

impl FromStr for Fields {
    type Err = UnknownField;

    /// Reads a list such as `velocity,density`; the empty list is no field.
    fn from_str(list: &str) -> Result<Self, UnknownField> {
        let mut fields = Fields::default();
        for word in list.split(',').map(str::trim).filter(|word| !word.is_empty()) {
            match word {
                "velocity" => fields.velocity = true,
                "density" => fields.density = true,
                "temperature" => fields.temperature = true,
                "samples" => fields.samples = true,
                "all" => fields = Fields { samples: fields.samples, ..Fields::ALL },
                _ => return Err(UnknownField(word.to_owned())),
            }
        }
        Ok(fields)
    }
}

impl fmt::Display for Fields {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = [
            (self.velocity, "velocity"),
            (self.density, "density"),
            (self.temperature, "temperature"),
            (self.samples, "samples"),
        ];
        let words: Vec<&str> = named.into_iter().filter(|(asked, _)| *asked).map(|(_, word)| word).collect();
        f.write_str(&words.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_fields_are_read_and_written() {
        assert_eq!("".parse(), Ok(Fields::default()));
        assert_eq!("all".parse(), Ok(Fields::ALL));
        let some: Fields = "density, velocity".parse().unwrap();
        assert_eq!(some, Fields { velocity: true, density: true, ..Fields::default() });
        assert_eq!(some.to_string(), "velocity,density");
        assert_eq!("speed".parse::<Fields>(), Err(UnknownField("speed".into())));
    }
}
