//! The contact properties of surfaces: restitution and friction.

/// The coefficient of friction of two bodies if neither specifies one.
const DEFAULT_FRICTION: f64 = 0.5;

/// The contact properties of a body's surface; `None` where the body does not specify a value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// The coefficient of restitution of the surface, from 0 to 1.
    pub restitution: Option<f64>,
    /// Coulomb's coefficient of friction.
    pub friction: Option<f64>,
    /// The coefficient of rolling friction, m: the resisting torque is the normal force times this.
    pub rolling_friction: Option<f64>,
}

/// The combined contact properties of two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactProperties {
    /// The coefficient of restitution.
    pub restitution: f64,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// The coefficient of rolling friction, m.
    pub rolling_friction: f64,
}

impl Surface {
    /// Combines two surfaces: the larger restitution, the geometric mean of the coefficients of friction, and the larger rolling friction.
    /// If only one surface specifies a value, this value counts. If neither does, the values are 0, 0.5 and 0.
    #[must_use]
    pub fn meet(&self, other: &Surface) -> ContactProperties {
        let mix = |a: Option<f64>, b: Option<f64>, both: fn(f64, f64) -> f64, neither: f64| match (a, b) {
            (Some(a), Some(b)) => both(a, b),
            (one, another) => one.or(another).unwrap_or(neither),
        };
        ContactProperties {
            restitution: mix(self.restitution, other.restitution, f64::max, 0.0),
            friction: mix(self.friction, other.friction, |a, b| (a * b).sqrt(), DEFAULT_FRICTION),
            rolling_friction: mix(self.rolling_friction, other.rolling_friction, f64::max, 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_surface_does_not_say_the_other_says() {
        let silent = Surface::default();
        let ball = Surface { restitution: Some(0.8), friction: Some(0.2), rolling_friction: Some(0.01) };
        let floor = Surface { restitution: Some(0.5), friction: Some(0.8), rolling_friction: None };
        let neither = ContactProperties { restitution: 0.0, friction: 0.5, rolling_friction: 0.0 };
        assert_eq!(silent.meet(&silent), neither);
        let one = ContactProperties { restitution: 0.8, friction: 0.2, rolling_friction: 0.01 };
        assert_eq!((silent.meet(&ball), ball.meet(&silent)), (one, one));
        let both = ball.meet(&floor);
        assert_eq!(both, floor.meet(&ball));
        assert_eq!((both.restitution, both.rolling_friction), (0.8, 0.01));
        assert!((both.friction - 0.4).abs() < 1e-15);
    }
}
