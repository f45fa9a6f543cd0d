//! Bare hands: their joints as the runtime tells them, and what they grab.

use game::Model;
use renderer::headset::{BareHand, HandReading, HeadsetSession, HeadsetSettings};

use crate::inside::{first_frame, found, is_inside, run_inside};
use crate::loss::play;
use crate::machine::runtime;
use crate::remote::{Packet, Remote};
use crate::room::{Hand, Room};
use crate::service::{Compositor, Service};

/// Of the right hand in the test below.
const CURL: f64 = 0.5;

/// Left and right hand as soon as the runtime sees the right one bare.
fn hands() -> [HandReading; 2] {
    let mut headset = HeadsetSession::open(found(), HeadsetSettings::default()).expect("a headset");
    first_frame(&mut headset, |headset, frame| {
        let readings = headset.read(&frame).expect("the service runs");
        headset.skip(frame).expect("the service runs");
        readings.hands[1].bare.is_some().then_some(readings.hands)
    })
}

/// The driver bends the joints of a hand by its curl: u_hand_simulation.c of Monado, `u_hand_sim_simulate_for_valve_index_knuckles`.
fn expected(curl: f64) -> [[f64; 3]; 5] {
    let turn = 1.1 * curl;
    let index = [1.3 * turn, turn, turn];
    let other = [1.3 * 1.3 * turn, 1.3 * turn, 0.4 * 1.3 * turn];
    let rest = 10.0_f64.to_radians();
    // The thumb's first is its own against the palm, which the driver does not bend.
    let thumb = [
        f64::NAN,
        (rest - 1.57 * curl).abs(),
        (rest - 1.4 * curl).abs(),
    ];
    [index, other, other, other, thumb]
}

#[test]
fn the_joints_of_a_bare_hand_are_bent_as_the_driver_bends_them() {
    if !is_inside() {
        let Some(runtime) = runtime() else { return };
        let service = Service::start(&runtime, Compositor::Null);
        let mut remote = Remote::connect(service.port()).expect("the service listens");
        let mut packet = Packet::default();
        packet.right.is_bare = true;
        packet.right.curl = CURL;
        remote.send(&packet).expect("the service listens");
        let name = "hands::the_joints_of_a_bare_hand_are_bent_as_the_driver_bends_them";
        run_inside(&service, name);
        return;
    }
    let [left, right] = hands();
    assert!(left.grip.is_some() && left.bare.is_none(), "{left:?}");
    assert!(right.grip.is_none(), "its controller was laid down");
    let BareHand { palm, bends, .. } = right.bare.expect("just seen");
    let place = Packet::default().right.pose.position;
    let away = palm.position.distance(place);
    assert!((0.01..0.15).contains(&away), "the palm is {away} m off");
    let expected = expected(CURL);
    for (finger, expected) in bends.iter().zip(&expected) {
        for (bend, expected) in finger.iter().zip(expected) {
            let off = (bend - expected).abs();
            assert!(expected.is_nan() || off < 0.02, "{bends:?}");
        }
    }
}

fn trigger(room: &Room) -> f64 {
    room.input.trigger
}

/// A fist grabs, a half open one holds on, an open hand lets go; the journal has it as a trigger, and its replay is the same.
#[test]
fn a_fist_grabs_holds_on_and_lets_go() {
    let Some(mut played) = play() else { return };
    let room = &mut played.room;
    room.lay_down_controllers(Hand::Right);
    room.take_ball(Hand::Right);
    assert_eq!(trigger(room), 1.0);
    let hand = &room.game.config().hand;
    let between = hand.trigger_open..hand.trigger_close;
    room.hand(Hand::Right).close(0.52);
    room.send();
    room.wait_until("a hand that opens", |room| between.contains(&trigger(room)));
    let steps = room.game.steps();
    room.wait_until("some time", |room| room.game.steps() > steps + 360);
    assert_eq!(room.game.held(), Some(Model::Ball(0)));
    room.hand(Hand::Right).close(0.0);
    room.send();
    room.wait_until("the release", |room| room.count("released") == 1);
    let released = room.event("released").expect("just seen");
    assert_eq!(
        released["source"], "poses",
        "the driver tells no velocity of a palm"
    );
    let before = trigger(room);
    assert!(before < 0.3, "{before}");
    room.wait_until("the poses behind the throw", |room| {
        !room.device("after_throw").is_empty()
    });
    let thrown = room.device("throw")[0].clone();
    let held = &thrown["readings"][0]["right"];
    assert!(
        held["grip"].is_null() && held["bare"]["grasp"].is_f64(),
        "{held}"
    );
    // A controller is taken up again, and plays.
    room.take_up_controllers();
    played.end();
}
