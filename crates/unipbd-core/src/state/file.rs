//! The state as bytes: magic, version, length, contents, checksum.

use super::error::damaged;
use super::{Section, State, StateError};
use crate::bytes::{Damage, Reader, Writer};
use crate::math::Vector64;
use crate::neighbors::SavedList;
use crate::particles::Particles;
use crate::rng::mix;
use crate::step::{Clock, Push};

const MAGIC: &[u8; 8] = b"unipbd\0S";
/// Version of the format; increased with every change of the contents.
const VERSION: u32 = 11;
const CHECKSUM_BYTES: usize = 8;

impl State {
    /// The state as bytes, the same for the same state.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.0.extend_from_slice(MAGIC);
        out.value(VERSION);
        out.value(self.structure.len() as u64);
        self.structure.iter().for_each(|line| out.text(line));
        write_clock(&self.clock, &mut out);
        self.particles.write(&mut out);
        self.list.write(&mut out);
        out.value(self.sections.len() as u64);
        for section in &self.sections {
            out.text(&section.name);
            out.column(&section.words);
        }
        let sum = checksum(&out.0);
        out.value(sum);
        out.0
    }

    /// The state from bytes.
    ///
    /// # Errors
    /// [`StateError`] if the bytes are of another format or version, or damaged.
    ///
    /// ```
    /// # use unipbd_core::{BuildOptions, scene::*};
    /// # use unipbd_core::State;
    /// # let water = vec![Liquid::new("water", 1000.0)];
    /// # let block = vec![Block::new("water", [0.0, 0.0], [1.0, 0.4])];
    /// # let tank = vec![Tank { name: "pool".into(), ..Tank::new([0.0, 0.0], [1.0, 1.0]) }];
    /// # let scene = Scene { spacing: 0.05, liquid: water, block, tank, ..Scene::default() };
    /// let mut solver = scene.build(BuildOptions::default())?;
    /// let bytes = solver.save().to_bytes(); // what a file holds
    /// let state = State::from_bytes(&bytes)?;
    /// solver.restore(&state)?;
    /// assert!(State::from_bytes(&bytes[1..]).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_bytes(bytes: &[u8]) -> Result<State, StateError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(StateError::NotAState)?;
        let found = Reader(rest).value::<u32>()?;
        if found != VERSION {
            return Err(StateError::Version { found, expected: VERSION });
        }
        let end = bytes.len().checked_sub(CHECKSUM_BYTES).filter(|end| *end >= MAGIC.len() + 4);
        let (contents, sum) = bytes.split_at(end.ok_or_else(|| damaged("it ends too early"))?);
        if Reader(sum).value::<u64>()? != checksum(contents) {
            return Err(damaged("its checksum does not match"));
        }
        let state = read(&mut Reader(&contents[MAGIC.len() + 4..]))?;
        state.check()?;
        Ok(state)
    }
}

fn read(input: &mut Reader<'_>) -> Result<State, StateError> {
    let structure = (0..input.count(8)?).map(|_| input.text()).collect::<Result<_, Damage>>()?;
    let clock = read_clock(input)?;
    let particles = Particles::read(input)?;
    let list = SavedList::read(input)?;
    let section = |input: &mut Reader<'_>| Ok(Section { name: input.text()?, words: input.column()? });
    let sections = (0..input.count(16)?).map(|_| section(input)).collect::<Result<_, Damage>>()?;
    if !input.0.is_empty() {
        return Err(damaged("something follows its end"));
    }
    Ok(State { structure, clock, particles, list, sections, read: true })
}

fn write_clock(clock: &Clock, out: &mut Writer) {
    for word in [clock.frame, clock.step, clock.generation] {
        out.value(word);
    }
    for count in [clock.substeps, clock.done, clock.list_builds, u32::from(clock.capped)] {
        out.value(count);
    }
    for value in [clock.time, clock.dt, clock.speed, clock.pressure_limit, clock.stiffness] {
        out.value(value);
    }
    for value in [clock.push.mean.x, clock.push.mean.y, clock.push.spread] {
        out.value(value);
    }
}

fn read_clock(input: &mut Reader<'_>) -> Result<Clock, Damage> {
    Ok(Clock {
        frame: input.value()?,
        step: input.value()?,
        generation: input.value()?,
        substeps: input.value()?,
        done: input.value()?,
        list_builds: input.value()?,
        capped: input.value::<u32>()? != 0,
        time: input.value()?,
        dt: input.value()?,
        speed: input.value()?,
        pressure_limit: input.value()?,
        stiffness: input.value()?,
        settling: false,
        push: Push { mean: Vector64::new(input.value()?, input.value()?), spread: input.value()? },
    })
}

/// Depends on every bit and on the length.
fn checksum(bytes: &[u8]) -> u64 {
    let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    bytes.chunks(8).fold(mix(bytes.len() as u64), |sum, chunk| mix(sum.rotate_left(5) ^ word(chunk)))
}
