//! The three-point linkage: piston travel -> rocker angle -> height of the hitch point.
//!
//! Planar, origin in the rocker shaft C, x to the rear, y up (docs/plant.md; dimensions of the paper's Table 1).
//! The rocker arm CB and the lift arm CD turn together; the lift rod DE carries the lower link FG at E.

use nalgebra::{Point2, Vector2};

use crate::components::linkage_error::LinkageError;
use crate::components::linkage_table::{LinkageTable, RisingCurve};

/// Dimensions of the linkage, m.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkageDimensions {
    /// Rocker arm CB.
    pub rocker_arm_m: f64,
    /// Lift arm CD, at a right angle to the rocker arm.
    pub lift_arm_m: f64,
    /// Lift rod DE.
    pub lift_rod_m: f64,
    /// Lower link FG.
    pub lower_link_m: f64,
    /// Distance of the lift rod's joint from the lower link's pivot, FE.
    pub lift_rod_joint_m: f64,
    /// Connecting rod AB.
    pub connecting_rod_m: f64,
    /// Pivot F of the lower link, x.
    pub pivot_x_m: f64,
    /// Pivot F of the lower link, y.
    pub pivot_y_m: f64,
    /// Height of the cylinder axis, y.
    pub cylinder_axis_y_m: f64,
}

/// Joints of the linkage in one position, m; the rocker shaft C is the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joints {
    /// Piston pin A.
    pub piston_pin: Point2<f64>,
    /// End B of the rocker arm.
    pub rocker_end: Point2<f64>,
    /// End D of the lift arm.
    pub lift_arm_end: Point2<f64>,
    /// Joint E of lift rod and lower link.
    pub rod_joint: Point2<f64>,
    /// Pivot F of the lower link.
    pub pivot: Point2<f64>,
    /// Hitch point G.
    pub hitch_point: Point2<f64>,
}

/// One position of the linkage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// Rocker angle, rad; pi/2 with the rocker straight down.
    pub rocker_angle_rad: f64,
    /// Height of the hitch point G over the shaft C, m.
    pub height_m: f64,
    /// Transmission dh/dx from piston travel to height.
    pub dh_dx: f64,
    /// Its derivative, 1/m.
    pub d2h_dx2_1_m: f64,
}

/// The linkage, solved once over the stroke; interpolated linearly between 1024 nodes, accurate to 1e-5 of the
/// transmission.
#[derive(Debug, Clone, PartialEq)]
pub struct Linkage {
    step_m: f64,
    /// Reciprocal of the step, which saves a division in the plant's innermost loop.
    cells_per_m: f64,
    nodes: Vec<Posture>,
}

const CELLS: usize = 1024;

/// Distance within which the ends of a measured linkage are those of the stroke, m.
const SAME_TRAVEL_M: f64 = 0.5e-3;

impl LinkageDimensions {
    /// The joints at a rocker angle.
    ///
    /// # Errors
    /// [`LinkageError`] if the dimensions cannot be assembled at this angle.
    pub fn joints(&self, rocker_angle_rad: f64) -> Result<Joints, LinkageError> {
        let (piston_pin, rocker_end) = self.pin_and_rocker_end(rocker_angle_rad)?;
        let [lift_arm_end, rod_joint, hitch_point] = self.lift_joints(rocker_angle_rad)?;
        Ok(Joints {
            piston_pin,
            rocker_end,
            lift_arm_end,
            rod_joint,
            pivot: self.pivot(),
            hitch_point,
        })
    }

    fn pivot(&self) -> Point2<f64> {
        Point2::new(self.pivot_x_m, self.pivot_y_m)
    }

    /// Piston pin A and end B of the rocker arm at a rocker angle.
    fn pin_and_rocker_end(
        &self,
        angle_rad: f64,
    ) -> Result<(Point2<f64>, Point2<f64>), LinkageError> {
        let rocker = Point2::from(self.rocker_arm_m * direction(angle_rad - std::f64::consts::PI));
        let rise = rocker.y - self.cylinder_axis_y_m;
        let along = square_root(self.connecting_rod_m.powi(2) - rise * rise);
        let along = along.ok_or(LinkageError::ConnectingRod {
            connecting_rod_m: self.connecting_rod_m,
            rise_m: rise.abs(),
            rocker_angle_deg: angle_rad.to_degrees(),
        })?;
        let pin = Point2::new(rocker.x - along, self.cylinder_axis_y_m);
        Ok((pin, rocker))
    }

    /// End D of the lift arm, joint E of the lift rod and hitch point G at a rocker angle.
    fn lift_joints(&self, angle_rad: f64) -> Result<[Point2<f64>; 3], LinkageError> {
        let arm_end =
            Point2::from(self.lift_arm_m * direction(angle_rad - std::f64::consts::FRAC_PI_2));
        let pivot = self.pivot();
        let span = arm_end - pivot;
        let reach = span.norm();
        let along = (reach * reach + self.lift_rod_joint_m.powi(2) - self.lift_rod_m.powi(2))
            / (2.0 * reach);
        let across = square_root(self.lift_rod_joint_m.powi(2) - along * along);
        let across = across.ok_or(LinkageError::LiftRod {
            lift_rod_m: self.lift_rod_m,
            least_m: (reach - self.lift_rod_joint_m).abs(),
            most_m: reach + self.lift_rod_joint_m,
            rocker_angle_deg: angle_rad.to_degrees(),
        })?;
        let unit = span / reach;
        // The triangle F-D-E closes in two ways; E is below the lift arm.
        let joint = along * unit - across * Vector2::new(-unit.y, unit.x);
        let hitch = pivot + joint * (self.lower_link_m / self.lift_rod_joint_m);
        Ok([arm_end, pivot + joint, hitch])
    }

    /// Travel coordinate of the piston pin A, m, at a rocker angle.
    fn pin_m(&self, angle_rad: f64) -> Result<f64, LinkageError> {
        Ok(self.pin_and_rocker_end(angle_rad)?.0.x)
    }

    /// Travel coordinate of the piston pin A, m, and height of G, m, at a rocker angle.
    fn pin_and_height_m(&self, angle_rad: f64) -> Result<(f64, f64), LinkageError> {
        let [.., hitch] = self.lift_joints(angle_rad)?;
        Ok((self.pin_m(angle_rad)?, hitch.y))
    }
}

fn direction(angle_rad: f64) -> Vector2<f64> {
    Vector2::new(angle_rad.cos(), angle_rad.sin())
}

fn square_root(value: f64) -> Option<f64> {
    (value >= 0.0).then(|| value.sqrt())
}

impl Linkage {
    /// A measured linkage over a stroke. Between its points angle and height are interpolated by rising cubic pieces,
    /// whose derivative is the transmission.
    ///
    /// # Errors
    /// [`LinkageError::Table`] if it does not cover the stroke.
    pub fn tabulated(table: &LinkageTable, stroke_m: f64) -> Result<Self, LinkageError> {
        let (first_m, last_m) = table.span_m();
        if first_m > SAME_TRAVEL_M || last_m < stroke_m - SAME_TRAVEL_M {
            return Err(LinkageError::Table {
                first_m,
                last_m,
                stroke_m,
            });
        }
        let angle = RisingCurve::through(table.travel_m(), table.angle_rad());
        let height = RisingCurve::through(table.travel_m(), table.height_m());
        let step_m = stroke_m / CELLS as f64;
        let nodes = (0..=CELLS).map(|node| {
            let node = node as f64;
            let (height_m, dh_dx) = height.at(step_m * node);
            let [below, above] = [node - 0.5, node + 0.5].map(|at| height.at(step_m * at).1);
            Posture {
                rocker_angle_rad: angle.at(step_m * node).0,
                height_m,
                dh_dx,
                d2h_dx2_1_m: (above - below) / step_m,
            }
        });
        Ok(Self {
            step_m,
            cells_per_m: step_m.recip(),
            nodes: nodes.collect(),
        })
    }

    /// Solves the linkage over a stroke whose rocker swing is symmetric about straight down.
    ///
    /// # Errors
    /// [`LinkageError`] if the dimensions cannot be assembled over the whole stroke.
    pub fn new(dimensions: &LinkageDimensions, stroke_m: f64) -> Result<Self, LinkageError> {
        let half_swing_rad = half_swing_rad(dimensions, stroke_m)?;
        let down = std::f64::consts::FRAC_PI_2;
        let (start_x, _) = dimensions.pin_and_height_m(down - half_swing_rad)?;
        let step_m = stroke_m / CELLS as f64;
        let mut angle_rad = down - half_swing_rad;
        let mut nodes = Vec::with_capacity(CELLS + 1);
        for node in 0..=CELLS {
            let pin_x = start_x + step_m * node as f64;
            angle_rad = angle_at_pin(dimensions, pin_x, angle_rad)?;
            nodes.push(posture(dimensions, angle_rad)?);
        }
        Ok(Self {
            step_m,
            cells_per_m: step_m.recip(),
            nodes,
        })
    }

    /// The posture at piston travel `piston_m`, clamped to the stroke.
    #[inline]
    #[must_use]
    pub fn at(&self, piston_m: f64) -> Posture {
        let (node, share) = self.cell(piston_m);
        let (a, b) = (&self.nodes[node], &self.nodes[node + 1]);
        let blend = |from: f64, to: f64| from + (to - from) * share;
        Posture {
            rocker_angle_rad: blend(a.rocker_angle_rad, b.rocker_angle_rad),
            height_m: blend(a.height_m, b.height_m),
            dh_dx: blend(a.dh_dx, b.dh_dx),
            d2h_dx2_1_m: blend(a.d2h_dx2_1_m, b.d2h_dx2_1_m),
        }
    }

    /// Only the transmission dh/dx at piston travel `piston_m`.
    #[inline]
    #[must_use]
    pub fn dh_dx(&self, piston_m: f64) -> f64 {
        let (node, share) = self.cell(piston_m);
        let (a, b) = (self.nodes[node].dh_dx, self.nodes[node + 1].dh_dx);
        a + (b - a) * share
    }

    /// The transmission dh/dx and its derivative, 1/m, at piston travel `piston_m`.
    #[inline]
    #[must_use]
    pub fn transmission(&self, piston_m: f64) -> (f64, f64) {
        let (node, share) = self.cell(piston_m);
        let (a, b) = (&self.nodes[node], &self.nodes[node + 1]);
        (
            a.dh_dx + (b.dh_dx - a.dh_dx) * share,
            a.d2h_dx2_1_m + (b.d2h_dx2_1_m - a.d2h_dx2_1_m) * share,
        )
    }

    /// Rotation of the rocker shaft per piston travel, rad/m, and its derivative, rad/m2, at piston travel `piston_m`.
    #[must_use]
    pub fn shaft_transmission(&self, piston_m: f64) -> (f64, f64) {
        let (node, share) = self.cell(piston_m);
        let node = node.clamp(1, CELLS - 2);
        let angle_rad = |node: usize| self.nodes[node].rocker_angle_rad;
        let slope = |node: usize| (angle_rad(node + 1) - angle_rad(node - 1)) / (2.0 * self.step_m);
        let (before, after) = (slope(node), slope(node + 1));
        (
            before + (after - before) * share,
            (after - before) / self.step_m,
        )
    }

    /// Piston travel, m, at a rocker angle, clamped to the swing.
    #[must_use]
    pub fn piston_m(&self, rocker_angle_rad: f64) -> f64 {
        let upper = self
            .nodes
            .partition_point(|node| node.rocker_angle_rad <= rocker_angle_rad)
            .clamp(1, CELLS);
        let (a, b) = (
            self.nodes[upper - 1].rocker_angle_rad,
            self.nodes[upper].rocker_angle_rad,
        );
        let share = ((rocker_angle_rad - a) / (b - a)).clamp(0.0, 1.0);
        self.step_m * ((upper - 1) as f64 + share)
    }

    /// Derivative of the rocker angle with respect to piston travel, rad/m, at a rocker angle.
    #[must_use]
    pub fn angle_slope_rad_m(&self, rocker_angle_rad: f64) -> f64 {
        let (node, _) = self.cell(self.piston_m(rocker_angle_rad));
        (self.nodes[node + 1].rocker_angle_rad - self.nodes[node].rocker_angle_rad) / self.step_m
    }

    /// Rocker angles at the two ends of the stroke, rad.
    #[must_use]
    pub fn swing_rad(&self) -> (f64, f64) {
        (
            self.nodes[0].rocker_angle_rad,
            self.nodes[CELLS].rocker_angle_rad,
        )
    }

    #[inline]
    fn cell(&self, piston_m: f64) -> (usize, f64) {
        let position = (piston_m * self.cells_per_m).clamp(0.0, CELLS as f64);
        let node = (position as usize).min(CELLS - 1);
        (node, position - node as f64)
    }
}

/// Travel of the pin from half a swing before straight down to half a swing after it, m.
fn sweep_m(dimensions: &LinkageDimensions, half_rad: f64) -> Result<f64, LinkageError> {
    let down = std::f64::consts::FRAC_PI_2;
    Ok(dimensions.pin_m(down + half_rad)? - dimensions.pin_m(down - half_rad)?)
}

/// Half the swing over `stroke_m`, by bisection: the travel increases with the swing.
fn half_swing_rad(dimensions: &LinkageDimensions, stroke_m: f64) -> Result<f64, LinkageError> {
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match sweep_m(dimensions, middle) {
            Ok(sweep) if sweep < stroke_m => low = middle,
            _ => high = middle,
        }
    }
    let half = 0.5 * (low + high);
    match sweep_m(dimensions, half) {
        Ok(sweep) if (sweep - stroke_m).abs() < 1e-9 => Ok(half),
        _ => Err(too_long(dimensions, stroke_m)),
    }
}

/// Error of a stroke that no swing covers.
fn too_long(dimensions: &LinkageDimensions, stroke_m: f64) -> LinkageError {
    const TRIES: i32 = 900;
    if let Err(open) = sweep_m(dimensions, 0.0) {
        return open;
    }
    let most_rad = std::f64::consts::FRAC_PI_2;
    let halves = (0..=TRIES).map(|i| most_rad * f64::from(i) / f64::from(TRIES));
    let swept = halves.map_while(|half_rad| sweep_m(dimensions, half_rad).ok());
    LinkageError::Stroke {
        rocker_arm_m: dimensions.rocker_arm_m,
        connecting_rod_m: dimensions.connecting_rod_m,
        stroke_m,
        most_m: swept.fold(0.0, f64::max),
    }
}

/// Rocker angle, rad, with the piston pin at `pin_x`: Newton's method from a nearby angle.
fn angle_at_pin(
    dimensions: &LinkageDimensions,
    pin_x: f64,
    near_rad: f64,
) -> Result<f64, LinkageError> {
    const STEP_RAD: f64 = 1e-6;
    let mut angle_rad = near_rad;
    for _ in 0..20 {
        let error_m = dimensions.pin_and_height_m(angle_rad)?.0 - pin_x;
        let ahead = dimensions.pin_and_height_m(angle_rad + STEP_RAD)?.0;
        let behind = dimensions.pin_and_height_m(angle_rad - STEP_RAD)?.0;
        let correction_rad = error_m * 2.0 * STEP_RAD / (ahead - behind);
        angle_rad -= correction_rad;
        if correction_rad.abs() < 1e-13 {
            break;
        }
    }
    Ok(angle_rad)
}

/// Posture, with derivatives over piston travel by central differences over the rocker angle.
fn posture(dimensions: &LinkageDimensions, angle_rad: f64) -> Result<Posture, LinkageError> {
    const STEP_RAD: f64 = 2e-4;
    let (x0, h0) = dimensions.pin_and_height_m(angle_rad)?;
    let (xa, ha) = dimensions.pin_and_height_m(angle_rad + STEP_RAD)?;
    let (xb, hb) = dimensions.pin_and_height_m(angle_rad - STEP_RAD)?;
    let (x1, h1) = ((xa - xb) / (2.0 * STEP_RAD), (ha - hb) / (2.0 * STEP_RAD));
    let square = STEP_RAD * STEP_RAD;
    let (x2, h2) = ((xa - 2.0 * x0 + xb) / square, (ha - 2.0 * h0 + hb) / square);
    Ok(Posture {
        rocker_angle_rad: angle_rad,
        height_m: h0,
        dh_dx: h1 / x1,
        d2h_dx2_1_m: (h2 * x1 - h1 * x2) / x1.powi(3),
    })
}
