//! The XPBD formula, once (Macklin et al. 2016, equation 18).

use crate::math::{Real, Vector};

/// Multiplier step of one constraint: `(-C - alpha lambda) / (sum w |grad C|^2 + alpha)`.
///
/// `alpha` is the compliance divided by dt^2.
#[inline]
pub(super) fn multiplier_step<const N: usize>(
    value: Real,
    gradients: &[Vector; N],
    inverse_masses: &[Real; N],
    lambda: Real,
    alpha: Real,
) -> Real {
    let mut denominator = alpha;
    for (gradient, inverse_mass) in gradients.iter().zip(inverse_masses) {
        denominator += inverse_mass * gradient.length_squared();
    }
    if denominator > 0.0 { (-value - alpha * lambda) / denominator } else { 0.0 }
}
