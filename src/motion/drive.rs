//! The differential drive of one robot under PID control (paper section 3.1, equation 1).

use super::config::{MotionConfig, PidConfig};
use super::pid::Pid;
use crate::geometry::{Vec2, clamp_length, unit, wrap_angle};

/// A robot asked to go slower than its largest speed over this is asked to stand: its heading is its own. 1 µm/s of the paper's
/// 0.026 m/s.
const STANDSTILL: f64 = 26_000.0;

/// What is the same for every drive of a world. SI units, angles in radians.
pub(super) struct Chassis {
    tick: f64,
    max_speed: f64,
    standstill: f64,
    max_turn_rate: f64,
    linear: PidConfig,
    angular: PidConfig,
}

/// One robot's drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive {
    command: Vec2,
    heading: f64,
    speed: f64,
    linear: Pid,
    angular: Pid,
}

impl Chassis {
    /// The chassis of `config`, with a tick of `tick` seconds.
    pub(super) fn new(config: &MotionConfig, tick: f64) -> Self {
        Self {
            tick,
            max_speed: config.max_speed.get(),
            standstill: config.max_speed.get() / STANDSTILL,
            max_turn_rate: config.max_turn_rate.get().to_radians(),
            linear: config.linear,
            angular: config.angular,
        }
    }
}

impl Drive {
    /// A drive that stands still.
    pub(super) fn new(heading: f64) -> Self {
        Self {
            command: Vec2::zeros(),
            heading: wrap_angle(heading),
            speed: 0.0,
            linear: Pid::default(),
            angular: Pid::default(),
        }
    }

    /// Sets the velocity to reach. One that is not finite asks to stand.
    pub(super) fn command(&mut self, chassis: &Chassis, velocity: Vec2) {
        let stands = !velocity.iter().all(|component| component.is_finite()) || velocity.norm() < chassis.standstill;
        self.command = if stands { Vec2::zeros() } else { velocity };
    }

    /// Whether it stands and is asked to: no tick changes it.
    pub(super) fn rests(&self) -> bool {
        self.command == Vec2::zeros() && self.speed == 0.0 && self.turn_rate() == 0.0
    }

    /// The heading `elapsed` seconds after the last tick.
    pub(super) fn heading(&self, elapsed: f64) -> f64 {
        wrap_angle(self.heading + self.turn_rate() * elapsed)
    }

    /// Turns for a whole tick.
    pub(super) fn turn(&mut self, chassis: &Chassis) {
        self.heading = self.heading(chassis.tick);
    }

    /// Chooses speed and turning rate for the coming tick and returns the velocity that they give.
    ///
    /// Constant speed v and turning rate ω make an arc; the velocity is that of its chord, so the robot is at every
    /// tick exactly where the arc would have taken it.
    pub(super) fn steer(&mut self, chassis: &Chassis) -> Vec2 {
        let wanted = clamp_length(self.command, chassis.max_speed);
        let (setpoint, turn_rate) = if wanted == Vec2::zeros() {
            self.angular = Pid::default();
            (0.0, 0.0)
        } else {
            let error = wrap_angle(wanted.y.atan2(wanted.x) - self.heading);
            let limits = (-chassis.max_turn_rate, chassis.max_turn_rate);
            let turn_rate = self.angular.step(&chassis.angular, chassis.tick, error, limits);
            (wanted.norm() * error.cos().max(0.0), turn_rate)
        };
        self.accelerate(chassis, setpoint);
        let half_turn = turn_rate * chassis.tick / 2.0;
        unit(self.heading + half_turn) * (self.speed * chord_share(half_turn))
    }

    fn turn_rate(&self) -> f64 {
        self.angular.output()
    }

    fn accelerate(&mut self, chassis: &Chassis, setpoint: f64) {
        let tick = chassis.tick;
        let limits = (-self.speed / tick, (chassis.max_speed - self.speed) / tick);
        let acceleration = self.linear.step(&chassis.linear, tick, setpoint - self.speed, limits);
        self.speed = (self.speed + acceleration * tick).clamp(0.0, chassis.max_speed);
        if setpoint == 0.0 && self.speed < chassis.standstill {
            self.speed = 0.0;
            self.linear = Pid::default();
        }
    }
}

/// Length of a circle's chord over that of its arc, which spans twice `half_turn`.
fn chord_share(half_turn: f64) -> f64 {
    if half_turn == 0.0 {
        1.0
    } else {
        half_turn.sin() / half_turn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn chassis() -> Chassis {
        Chassis::new(&MotionConfig::default(), 0.1)
    }

    #[test]
    fn a_robot_that_faces_its_way_gains_half_of_the_missing_speed_each_tick() {
        let mut drive = Drive::new(0.0);
        drive.command(&chassis(), Vec2::new(0.02, 0.0));
        for n in 1..10 {
            let velocity = drive.steer(&chassis());
            assert!((velocity - Vec2::new(0.02 * (1.0 - 0.5_f64.powi(n)), 0.0)).norm() < 1e-15);
            drive.turn(&chassis());
        }
    }

    #[test]
    fn a_turn_in_place_settles_within_a_degree_in_two_seconds_and_never_overshoots() {
        let mut drive = Drive::new(0.0);
        drive.command(&chassis(), unit(PI * 0.99) * 0.026);
        let mut error = PI * 0.99;
        for _ in 0..20 {
            drive.steer(&chassis());
            drive.turn(&chassis());
            let left = PI * 0.99 - drive.heading(0.0);
            // The proportional gain is below 1 / tick, so the error shrinks and keeps its sign.
            assert!((0.0..error).contains(&left), "{left} after {error}");
            error = left;
        }
        assert!(error < 1_f64.to_radians());
    }

    #[test]
    fn a_robot_that_faces_away_turns_before_it_drives() {
        let mut drive = Drive::new(PI);
        drive.command(&chassis(), Vec2::new(0.026, 0.0));
        for _ in 0..4 {
            assert_eq!(drive.steer(&chassis()), Vec2::zeros());
            drive.turn(&chassis());
        }
    }

    #[test]
    fn a_robot_asked_to_stand_brakes_to_rest_and_keeps_its_heading() {
        let mut drive = Drive::new(0.5);
        drive.command(&chassis(), unit(0.5) * 0.026);
        for _ in 0..20 {
            drive.steer(&chassis());
            drive.turn(&chassis());
        }
        drive.command(&chassis(), Vec2::new(1e-9, f64::NAN));
        let heading = drive.heading(0.0);
        for _ in 0..20 {
            drive.steer(&chassis());
            drive.turn(&chassis());
        }
        assert!(drive.rests());
        assert!((drive.heading(0.0) - heading).abs() < 1e-15);
    }

    #[test]
    fn a_tick_ends_where_the_arc_of_equation_one_does() {
        // A robot with constant speed and turning rate runs on a circle of radius v/ω.
        let (speed, turn_rate, tick) = (0.4, 3.0, 0.1);
        let half_turn = turn_rate * tick / 2.0;
        let chord = unit(half_turn) * (speed * chord_share(half_turn)) * tick;
        let radius = speed / turn_rate;
        let (sin, cos) = (turn_rate * tick).sin_cos();
        assert!((chord - Vec2::new(radius * sin, radius * (1.0 - cos))).norm() < 1e-15);
    }

    proptest! {
        #[test]
        fn speed_and_turning_rate_keep_their_limits_under_any_commands(
            commands in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 1..60),
            p in 0.1..19.0_f64, i in 0.0..20.0_f64, d in 0.0..0.9_f64,
        ) {
            let mut config = MotionConfig::default();
            let gains = PidConfig { p: p.try_into().unwrap(), i: i.try_into().unwrap(), d: d.try_into().unwrap() };
            (config.linear, config.angular) = (gains, gains);
            let chassis = Chassis::new(&config, 0.1);
            let mut drive = Drive::new(1.0);
            for (x, y) in commands {
                drive.command(&chassis, Vec2::new(x, y));
                let before = drive.heading(0.0);
                let velocity = drive.steer(&chassis);
                drive.turn(&chassis);
                prop_assert!(velocity.norm() <= 0.026 + 1e-15);
                let turned = wrap_angle(drive.heading(0.0) - before).abs();
                prop_assert!(turned <= 18_f64.to_radians() + 1e-12);
            }
            prop_assert!(drive.heading(0.0).abs() <= 2.0 * FRAC_PI_2);
        }
    }
}
