//! The axes of a cloud: its reference rotation, and the directions in which it is widest about that.

use super::super::Cloud;
use super::super::principal::principal;
use condyle_math::{Mat3, Quat, Vec3};
use condyle_model::limit::field::Chart;

pub(super) fn of(cloud: &Cloud) -> Chart {
    let back = cloud.reference().conjugate();
    let mut moments = [[0.0; 3]; 3];
    for (q, weight) in cloud.rotations().iter().zip(cloud.weights()) {
        let to = (back * *q).log().to_array();
        for i in 0..3 {
            for j in 0..3 {
                moments[i][j] += weight * to[i] * to[j];
            }
        }
    }
    let (_, [a, b, _]) = principal(moments);
    let (a, b) = (Vec3::from(a), Vec3::from(b));
    Chart::new(cloud.reference(), Quat::from_mat3(Mat3::from_columns(a, b, a.cross(b))))
}
