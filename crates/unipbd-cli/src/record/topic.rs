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
    /// Every topic.
    pub(crate) const ALL: [Topic; 10] = [
        Topic::Particles,
        Topic::Boundary,
        Topic::BodySamples,
        Topic::Scene,
        Topic::Transforms,
        Topic::Diagnostics,
        Topic::Gauges,
        Topic::Columns,
        Topic::Bodies,
        Topic::Log,
    ];

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
        Topic::ALL.into_iter().find(|topic| topic.name() == name)
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

/// A set of topics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Topics(u16);

impl Topics {
    /// Every topic.
    pub(crate) const ALL: Topics = Topics((1 << Topic::ALL.len()) - 1);

    /// Whether the topic is one of them.
    pub(crate) fn contains(self, topic: Topic) -> bool {
        self.0 & (1 << topic as u16) != 0
    }

    /// Whether there are none.
    #[cfg(feature = "live")]
    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Adds those of another set.
    pub(crate) fn extend(&mut self, other: Topics) {
        self.0 |= other.0;
    }

    /// Takes those of another set away.
    pub(crate) fn remove(&mut self, other: Topics) {
        self.0 &= !other.0;
    }
}

impl FromIterator<Topic> for Topics {
    fn from_iter<I: IntoIterator<Item = Topic>>(topics: I) -> Self {
        Topics(topics.into_iter().fold(0, |set, topic| set | 1 << topic as u16))
    }
}
