use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::time::Duration;

use glam::{DQuat, DVec3};
use physics::Pose;

/// Bytes of one packet: `struct r_remote_data` of Monado 25.0.0, `src/xrt/drivers/remote/r_interface.h`.
const SIZE: usize = 376;
/// Every packet begins with it, zero included.
const HEADER: [u8; 8] = *b"mndrmt3\0";
/// Head's pose, after the header and two views of 48 bytes that a flag behind the pose leaves unused.
const HEAD: usize = 104;
const LEFT: usize = 136;
const RIGHT: usize = 256;
/// Longest wait for the driver: a stopped service must fail a test, not hold it for ever.
const PATIENCE: Duration = Duration::from_secs(10);

/// What a hand holds: where it is, how it moves, what it presses.
///
/// World frame of the runtime: metres, y up, -z forward, the floor at y = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// Grip from the controller to the world [m].
    pub pose: Pose,
    /// [m/s], world axes.
    pub linear_velocity: DVec3,
    /// [rad/s], world axes. The driver wants the body's own; the packet is written so.
    pub angular_velocity: DVec3,
    /// 0 free to 1 pulled through.
    pub trigger: f64,
    /// 0 open to 1 closed around the grip.
    pub squeeze: f64,
    /// 0 to 1, beyond a closed grip.
    pub squeeze_force: f64,
    /// The lower thumb button.
    pub a: bool,
    /// The upper thumb button.
    pub b: bool,
    /// False: as if it were switched off.
    pub is_tracked: bool,
    /// Laid down: the runtime sees the hand instead, as long as it is tracked.
    pub is_bare: bool,
    /// How far all fingers are curled, 0 to 1; of a hand, whether it has a controller or not.
    pub curl: f64,
}

impl Controller {
    /// A controller held still, with nothing pressed.
    pub fn at(pose: Pose) -> Self {
        Self {
            pose,
            linear_velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            trigger: 0.0,
            squeeze: 0.0,
            squeeze_force: 0.0,
            a: false,
            b: false,
            is_tracked: true,
            is_bare: false,
            curl: 0.0,
        }
    }

    /// Closes the hand, round a controller's trigger or as it is, from 0 to 1.
    pub fn close(&mut self, share: f64) {
        match self.is_bare {
            true => self.curl = share,
            false => self.trigger = share,
        }
    }

    fn write(&self, bytes: &mut [u8]) {
        let angular_in_body = self.pose.rotation.inverse() * self.angular_velocity;
        put_pose(bytes, 0, self.pose);
        put(bytes, 28, &self.linear_velocity.to_array());
        put(bytes, 40, &angular_in_body.to_array());
        put(bytes, 52, &[self.curl; 5]);
        put(bytes, 72, &[self.trigger, self.squeeze, self.squeeze_force]);
        // Hand tracking goes with the controller, as the driver has it at its start.
        let flags = [
            (104, self.is_tracked),
            (105, self.is_tracked && !self.is_bare),
            (108, self.a),
            (109, self.a),
            (110, self.b),
            (111, self.b),
            (112, self.trigger >= 1.0),
            (113, self.trigger > 0.0),
        ];
        for (at, flag) in flags {
            bytes[at] = u8::from(flag);
        }
    }
}

/// All that the driver shows from one packet to the next: it extrapolates nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Packet {
    /// Between the eyes, from the head to the world [m].
    pub head: Pose,
    /// Left hand.
    pub left: Controller,
    /// Right hand.
    pub right: Controller,
}

impl Default for Packet {
    /// Where the driver has head and hands before the first packet.
    fn default() -> Self {
        let at = |x, y, z| Pose {
            position: DVec3::new(x, y, z),
            rotation: DQuat::IDENTITY,
        };
        Self {
            head: at(0.0, 1.6, 0.0),
            left: Controller::at(at(-0.2, 1.3, -0.5)),
            right: Controller::at(at(0.2, 1.3, -0.5)),
        }
    }
}

impl Packet {
    fn bytes(&self) -> [u8; SIZE] {
        let mut bytes = [0; SIZE];
        bytes[..HEADER.len()].copy_from_slice(&HEADER);
        put_pose(&mut bytes, HEAD, self.head);
        self.left.write(&mut bytes[LEFT..RIGHT]);
        self.right.write(&mut bytes[RIGHT..]);
        bytes
    }
}

/// Writes `values` as the single precision that the driver reads, from byte `at` on.
fn put(bytes: &mut [u8], at: usize, values: &[f64]) {
    for (slot, value) in bytes[at..].chunks_exact_mut(4).zip(values) {
        slot.copy_from_slice(&(*value as f32).to_le_bytes());
    }
}

fn put_pose(bytes: &mut [u8], at: usize, pose: Pose) {
    put(bytes, at, &pose.rotation.to_array());
    put(bytes, at + 16, &pose.position.to_array());
}

/// A connection to the remote driver, which serves one at a time.
pub struct Remote {
    stream: TcpStream,
    /// Where everything stood when this connected.
    latest: [u8; SIZE],
}

impl Remote {
    /// Connects to the driver on `port` of this machine and takes the two packets that it begins with: where everything
    /// stood at the driver's start, and where it stands now.
    ///
    /// The service dies of writing to a connection that was given up before it wrote: one that is stopped while this
    /// waits does not survive its going on.
    ///
    /// # Errors
    /// When nobody listens, when the driver is silent for [`PATIENCE`], or when it has another layout.
    pub fn connect(port: u16) -> io::Result<Self> {
        let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port))?;
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let mut start = [0; SIZE];
        let mut latest = [0; SIZE];
        stream.read_exact(&mut start)?;
        stream.read_exact(&mut latest)?;
        // The driver leaves its own header empty, so where things stand must tell its layout from another's.
        if start[HEADER.len()..] != Packet::default().bytes()[HEADER.len()..] {
            let problem = format!(
                "what listens on port {port} is no remote driver of Monado 25.0.0: it begins with {start:?}"
            );
            return Err(io::Error::new(io::ErrorKind::InvalidData, problem));
        }
        Ok(Self { stream, latest })
    }

    /// Moves everything to where `packet` has it.
    ///
    /// # Errors
    /// When the service is gone, or takes nothing for [`PATIENCE`].
    pub fn send(&mut self, packet: &Packet) -> io::Result<()> {
        self.stream.write_all(&packet.bytes())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::machine::runtime;
    use crate::service::{Compositor, Service};

    /// Head, left and right told apart by their numbers; all of them fit single precision.
    fn distinct() -> Packet {
        let turned = Pose {
            position: DVec3::new(0.5, 1.25, -0.75),
            rotation: DQuat::from_rotation_y(FRAC_PI_2),
        };
        let mut packet = Packet::default();
        packet.head.position = DVec3::new(0.125, 1.75, 2.0);
        packet.left.is_tracked = false;
        packet.left.b = true;
        packet.right = Controller {
            linear_velocity: DVec3::new(-1.0, 0.25, -8.0),
            angular_velocity: DVec3::new(2.0, 0.0, 0.0),
            trigger: 0.5,
            squeeze: 0.75,
            squeeze_force: 0.25,
            a: true,
            ..Controller::at(turned)
        };
        packet
    }

    #[test]
    fn packet_has_every_field_where_the_driver_reads_it() {
        let bytes = distinct().bytes();
        let at = |offset: usize| {
            f32::from_le_bytes(bytes[offset..offset + 4].try_into().expect("four bytes"))
        };
        let three = |offset: usize| [at(offset), at(offset + 4), at(offset + 8)];
        // r_interface.h, counted by hand: header 8, two views of 48, centre pose 28 and flags 4; then 120 bytes for each
        // hand: rotation 16, position 12, linear 12, angular 12, five curls 20, trigger, squeeze, force ...
        assert_eq!(bytes[..8], *b"mndrmt3\0");
        assert_eq!([at(104), at(108), at(112), at(116)], [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(three(120), [0.125, 1.75, 2.0], "head");
        assert_eq!(three(136 + 16), [-0.2, 1.3, -0.5], "left hand");
        let half = std::f32::consts::FRAC_1_SQRT_2;
        assert!((at(256 + 4) - half).abs() < 1e-6 && (at(256 + 12) - half).abs() < 1e-6);
        assert_eq!(three(256 + 16), [0.5, 1.25, -0.75], "right hand");
        assert_eq!(three(256 + 28), [-1.0, 0.25, -8.0], "linear");
        assert_eq!(three(256 + 72), [0.5, 0.75, 0.25], "trigger, squeeze");
        // ... and from byte 104 on: hand tracked, active, system, a, b, trigger: each clicked, touched.
        assert_eq!(
            bytes[136 + 104..136 + 116],
            [0, 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0]
        );
        assert_eq!(
            bytes[256 + 104..256 + 116],
            [1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0]
        );
    }

    #[test]
    fn packet_has_the_angular_velocity_in_the_bodys_frame() {
        let bytes = distinct().bytes();
        let at = |offset: usize| {
            f32::from_le_bytes(bytes[offset..offset + 4].try_into().expect("four bytes"))
        };
        // A quarter turn about y lays the body's z along the world's x.
        let body = [at(256 + 40), at(256 + 44), at(256 + 48)];
        for (value, expected) in body.into_iter().zip([0.0, 0.0, 2.0]) {
            assert!((value - expected).abs() < 1e-6, "{body:?}");
        }
    }

    #[test]
    fn the_driver_stands_where_the_last_packet_put_it() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let mut remote = Remote::connect(service.port()).expect("the driver listens");
        assert_eq!(remote.latest[8..], Packet::default().bytes()[8..]);
        remote.send(&Packet::default()).expect("the driver reads");
        remote.send(&distinct()).expect("the driver reads");
        drop(remote);
        // It reads all that was sent before it takes the next connection.
        let again = Remote::connect(service.port()).expect("the driver listens again");
        assert_eq!(again.latest, distinct().bytes());
    }
}
