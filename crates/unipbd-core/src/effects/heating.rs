use super::{Changes, Effect};
use crate::constraints::{Needs, Substep};
use crate::math::{Real, real, wide};
use crate::phase::Phase;
use crate::scene::{Region, Scene};

/// Heaters: gas in a region takes the temperature of its heater, dT/dt = rate (T_heater - T), implicit.
pub struct Heating {
    heaters: Vec<(Region, Real, Real)>,
}

impl Heating {
    /// The heaters of a scene; `None` where there are none.
    pub fn new(scene: &Scene) -> Option<Self> {
        let of = |heater: &crate::scene::Heater| (heater.region.clone(), real(heater.temperature), real(heater.rate));
        (!scene.heater.is_empty()).then(|| Heating { heaters: scene.heater.iter().map(of).collect() })
    }
}

impl Effect for Heating {
    fn name(&self) -> &'static str {
        "heating"
    }

    fn needs(&self) -> Needs {
        Needs::NOTHING
    }

    fn apply(&mut self, now: Substep<'_>, out: &mut Changes) {
        let (positions, phases) = (now.particles.positions(), now.particles.phases());
        let temperatures = now.particles.temperatures();
        now.parallelism.update(&mut out.temperature, |row, change| {
            if phases[row] != Phase::Gas {
                return;
            }
            let place = wide(positions[row]).into();
            for (region, temperature, rate) in &self.heaters {
                if region.contains(place) {
                    let pull = rate * now.dt;
                    *change += (temperature - temperatures[row]) * (pull / (1.0 + pull));
                }
            }
        });
    }
}
