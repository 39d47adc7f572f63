//! The impulse of a contact on its two bodies.

use crate::math::Vector64;
use crate::rigid::Twist;

/// Equal and opposite pushes on two bodies.
#[derive(Clone, Copy, Debug, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Push {
    pub linear: Vector64,
    pub angular_a: f64,
    pub angular_b: f64,
}

impl Push {
    pub fn on_a(&self) -> Twist {
        Twist { linear: self.linear, angular: self.angular_a }
    }

    pub fn on_b(&self) -> Twist {
        Twist { linear: self.linear, angular: self.angular_b }
    }
}

impl std::ops::AddAssign for Push {
    fn add_assign(&mut self, other: Push) {
        self.linear += other.linear;
        self.angular_a += other.angular_a;
        self.angular_b += other.angular_b;
    }
}
