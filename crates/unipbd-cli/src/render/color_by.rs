/// The quantity that the colour of a particle shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// The colour of its material.
    #[default]
    Material,
    /// Its speed [m/s].
    Speed,
    /// Its density error [%].
    Density,
    /// Its temperature above the surroundings.
    Temperature,
}

impl ColorBy {
    /// All choices.
    pub const ALL: [ColorBy; 4] = [ColorBy::Material, ColorBy::Speed, ColorBy::Density, ColorBy::Temperature];

    /// The word for it on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            ColorBy::Material => "material",
            ColorBy::Speed => "speed",
            ColorBy::Density => "density",
            ColorBy::Temperature => "temperature",
        }
    }

    /// The column it needs, by the name `--fields` has for it.
    pub const fn field(self) -> Option<&'static str> {
        match self {
            ColorBy::Material => None,
            ColorBy::Speed => Some("velocity"),
            ColorBy::Density => Some("density"),
            ColorBy::Temperature => Some("temperature"),
        }
    }

    /// Title of the colour bar, with the unit.
    pub(super) const fn label(self) -> &'static str {
        match self {
            ColorBy::Material => "",
            ColorBy::Speed => "speed [m/s]",
            ColorBy::Density => "density error [%]",
            ColorBy::Temperature => "temperature",
        }
    }
}
