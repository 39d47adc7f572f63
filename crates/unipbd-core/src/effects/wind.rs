use crate::math::{Real, Vector, Vector64, real, vector};
use crate::rng::mix;
use crate::scene::Environment;

/// The velocity of the air around an open scene: a mean and smooth random gusts.
#[derive(Clone, Debug)]
pub struct Wind {
    mean: Vector,
    gusts: Real,
    inverse_length: Real,
    inverse_time: f64,
    seed: u64,
}

/// The wind at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    wind: &'a Wind,
    slice: u64,
    part: Real,
}

impl Wind {
    /// The wind of an environment; its gusts follow the seed.
    pub fn new(environment: &Environment, spacing: f64, seed: u64) -> Self {
        let or = |value: f64, default: f64| if value > 0.0 { value } else { default };
        Wind {
            mean: vector(Vector64::from(environment.velocity)),
            gusts: real(environment.gusts),
            inverse_length: real(1.0 / or(environment.gust_length, 10.0 * spacing)),
            inverse_time: 1.0 / or(environment.gust_time, 0.5),
            seed,
        }
    }

    /// The wind at this time \[s].
    pub fn at(&self, time: f64) -> Moment<'_> {
        let slices = time * self.inverse_time;
        Moment { wind: self, slice: slices.floor() as i64 as u64, part: smooth(real(slices - slices.floor())) }
    }

    /// Value noise: random vectors at the nodes of a lattice, blended smoothly between them.
    fn gust(&self, slice: u64, x: Vector) -> Vector {
        let cell = x.floor();
        let part = Vector::new(smooth(x.x - cell.x), smooth(x.y - cell.y));
        let node = |dx: Real, dy: Real| self.node(slice, cell + Vector::new(dx, dy));
        let low = node(0.0, 0.0).lerp(node(1.0, 0.0), part.x);
        low.lerp(node(0.0, 1.0).lerp(node(1.0, 1.0), part.x), part.y)
    }

    fn node(&self, slice: u64, cell: Vector) -> Vector {
        let key = mix(self.seed ^ mix(slice ^ mix((cell.x as i64 as u64) ^ mix(cell.y as i64 as u64))));
        let unit = |bits: u64| (bits & 0xFFFF) as Real / 32768.0 - 1.0;
        Vector::new(unit(key), unit(key >> 16))
    }
}

impl Moment<'_> {
    /// Velocity of the air at a point [m/s].
    pub fn velocity(&self, x: Vector) -> Vector {
        let wind = self.wind;
        if wind.gusts == 0.0 {
            return wind.mean;
        }
        let at = x * wind.inverse_length;
        let gust = wind.gust(self.slice, at).lerp(wind.gust(self.slice.wrapping_add(1), at), self.part);
        wind.mean + gust * wind.gusts
    }
}

fn smooth(t: Real) -> Real {
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_are_continuous_bounded_and_follow_the_seed() {
        let environment = Environment { gusts: 2.0, gust_length: 1.0, ..Environment::default() };
        let (wind, other) = (Wind::new(&environment, 0.1, 1), Wind::new(&environment, 0.1, 2));
        let mut differs = false;
        for i in 0..200 {
            let (x, time) = (Vector::new(0.1 * i as Real - 10.0, -0.37), 0.05 * f64::from(i));
            let here = wind.at(time).velocity(x);
            let near = wind.at(time + 1e-3).velocity(x + Vector::splat(1e-3));
            assert!((here - near).length() < 0.05, "jump at {x}");
            assert!(here.abs().max_element() <= 2.0);
            differs |= here != other.at(time).velocity(x);
        }
        assert!(differs);
    }
}
