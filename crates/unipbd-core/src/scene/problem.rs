use std::fmt;

/// One step of a [`KeyPath`]: a key or the number of a table in an array.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum KeySegment {
    /// A key of a table.
    Key(String),
    /// An index into an array, from 0.
    Index(usize),
}

/// Where in a scene a value stands, such as `emitter[0].position`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct KeyPath(pub Vec<KeySegment>);

impl KeyPath {
    /// The path of a top-level key.
    pub fn key(key: &str) -> Self {
        KeyPath(vec![KeySegment::Key(key.to_owned())])
    }

    /// The path of the table number `index` of a table array.
    pub fn entry(array: &str, index: usize) -> Self {
        KeyPath(vec![KeySegment::Key(array.to_owned()), KeySegment::Index(index)])
    }

    /// This path with one more key behind it.
    #[must_use]
    pub fn then(&self, key: &str) -> Self {
        let mut path = self.clone();
        path.0.push(KeySegment::Key(key.to_owned()));
        path
    }

    /// This path with the number of an array element behind it.
    #[must_use]
    pub fn then_index(&self, index: usize) -> Self {
        let mut path = self.clone();
        path.0.push(KeySegment::Index(index));
        path
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, segment) in self.0.iter().enumerate() {
            match segment {
                KeySegment::Key(key) if position == 0 => f.write_str(key)?,
                KeySegment::Key(key) => write!(f, ".{key}")?,
                KeySegment::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where it is.
    pub path: KeyPath,
    /// What is wrong, with the offending value.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path, self.message)?;
        match &self.hint {
            Some(hint) => write!(f, " ({hint})"),
            None => Ok(()),
        }
    }
}

/// Everything that is wrong with a scene, in the order of the description.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    /// Adds a problem without a hint.
    pub(crate) fn add(&mut self, path: KeyPath, message: impl Into<String>) {
        self.0.push(Problem { path, message: message.into(), hint: None });
    }

    /// Adds a problem with a hint.
    pub(crate) fn add_with_hint(&mut self, path: KeyPath, message: impl Into<String>, hint: impl Into<String>) {
        self.0.push(Problem { path, message: message.into(), hint: Some(hint.into()) });
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, problem) in self.0.iter().enumerate() {
            if position > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}
