//! Computes the principal axes and moments of an inertia tensor.

use glam::{DMat3, DQuat, DVec3};

/// Off-diagonal elements count as rounding errors if they are below this fraction of the trace.
const RELATIVE_ROUNDING: f64 = 1e-15;
/// The largest number of sweeps over the off-diagonal elements. Far fewer suffice, because each sweep squares their relative size.
const MAX_SWEEPS: usize = 30;

/// Returns the eigenvalues of a symmetric matrix, and the rotation from its eigenvectors, in the same order, to the coordinate axes. For a
/// matrix that is diagonal up to rounding, returns its diagonal and the identity.
///
/// Jacobi's method, in sweeps (W. H. Press et al., *Numerical Recipes*, ch. 11.1). Each rotation makes one element zero, by the smaller of
/// two angles. The method uses only square roots, so it gives the same bits on all platforms.
pub(super) fn principal(tensor: DMat3) -> (DVec3, DQuat) {
    let mut matrix = tensor.to_cols_array_2d();
    let least = RELATIVE_ROUNDING * (matrix[0][0] + matrix[1][1] + matrix[2][2]);
    let (mut axes, mut turned) = (DMat3::IDENTITY, false);
    for _ in 0..MAX_SWEEPS {
        let mut done = true;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let beside = matrix[p][q];
            if beside.abs() <= least || !beside.is_finite() {
                continue;
            }
            let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * beside);
            let tangent = 1f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            let mut rotation = DMat3::IDENTITY.to_cols_array_2d();
            (rotation[p][p], rotation[p][q]) = (cosine, -sine);
            (rotation[q][p], rotation[q][q]) = (sine, cosine);
            let rotation = DMat3::from_cols_array_2d(&rotation);
            let turned_matrix = rotation.transpose() * DMat3::from_cols_array_2d(&matrix) * rotation;
            matrix = turned_matrix.to_cols_array_2d();
            axes *= rotation;
            (done, turned) = (false, true);
        }
        if done {
            break;
        }
    }
    let values = DVec3::new(matrix[0][0], matrix[1][1], matrix[2][2]);
    let rotation = if turned { DQuat::from_mat3(&axes).normalize() } else { DQuat::IDENTITY };
    (values, rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tensor_is_its_principal_moments_turned() {
        for (moments, turn) in [
            (DVec3::new(1.0, 2.0, 2.5), DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0)),
            (DVec3::new(2.0, 2.0, 3.0), DQuat::from_euler(glam::EulerRot::XYZ, 0.7, 0.1, -0.4)),
            (DVec3::new(1e-3, 1.0, 1.0), DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4)),
        ] {
            let turned = |moments: DVec3, turn: DQuat| {
                let turn = DMat3::from_quat(turn);
                turn * DMat3::from_diagonal(moments) * turn.transpose()
            };
            let tensor = turned(moments, turn);
            let (values, axes) = principal(tensor);
            assert!(turned(values, axes).abs_diff_eq(tensor, 1e-14), "{moments} {values} {axes}");
            let sorted = |v: DVec3| {
                let mut v = v.to_array();
                v.sort_unstable_by(f64::total_cmp);
                DVec3::from_array(v)
            };
            assert!(sorted(values).abs_diff_eq(moments, 1e-14), "{moments} {values}");
        }
    }

    #[test]
    fn a_diagonal_matrix_is_not_turned() {
        let moments = DVec3::new(3.0, 1.0, 2.0);
        let mut tensor = DMat3::from_diagonal(moments);
        (tensor.x_axis.y, tensor.y_axis.x) = (1e-16, 1e-16);
        assert_eq!(principal(tensor), (moments, DQuat::IDENTITY));
    }
}
