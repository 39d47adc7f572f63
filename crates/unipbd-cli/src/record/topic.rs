use super::{gauge_message, messages, schema};

/// The topics of a log. A topic a run does not use has no channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Topic {
    Particles,
    Boundary,
    BodySamples,
    Scene,
    Transforms,
    Diagnostics,
    Gauges,
    Columns,
    Bodies,
    Log,
}

impl Topic {
    /// The name in the log.
    pub(crate) fn name(self) -> String {
        match self {
            Topic::Particles => "/particles".to_owned(),
            Topic::Boundary => "/boundary".to_owned(),
            Topic::BodySamples => "/bodies/samples".to_owned(),
            Topic::Scene => "/scene".to_owned(),
            Topic::Transforms => "/tf".to_owned(),
            Topic::Diagnostics => "/diagnostics".to_owned(),
            Topic::Gauges => "/gauges".to_owned(),
            Topic::Columns => "/particles/columns".to_owned(),
            Topic::Bodies => "/bodies".to_owned(),
            Topic::Log => "/log".to_owned(),
        }
    }

    /// The topic with this name, if it is one of ours.
    pub(crate) fn from_name(name: &str) -> Option<Topic> {
        use Topic::{Bodies, BodySamples, Boundary, Columns, Diagnostics, Gauges, Log, Particles, Scene, Transforms};
        [Particles, Boundary, BodySamples, Scene, Transforms, Diagnostics, Gauges, Columns, Bodies, Log]
            .into_iter()
            .find(|topic| topic.name() == name)
    }

    /// Name and descriptor set of its messages, in a run with these gauges.
    pub(crate) fn schema(self, gauges: &[String]) -> (String, Vec<u8>) {
        match self {
            Topic::Particles | Topic::Boundary | Topic::BodySamples => messages::schema::<messages::PointCloud>(),
            Topic::Scene => messages::schema::<messages::SceneUpdate>(),
            Topic::Transforms => messages::schema::<messages::FrameTransforms>(),
            Topic::Log => messages::schema::<messages::Log>(),
            Topic::Diagnostics => ("unipbd.Diagnostics".to_owned(), schema::descriptor_set()),
            Topic::Gauges => ("unipbd.Gauges".to_owned(), gauge_message::descriptor_set(gauges)),
            Topic::Columns => ("unipbd.ParticleColumns".to_owned(), schema::descriptor_set()),
            Topic::Bodies => ("unipbd.Bodies".to_owned(), schema::descriptor_set()),
        }
    }
}
