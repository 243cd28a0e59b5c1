//! Bodies from MJCF: against what MuJoCo makes of the same files, and what is refused.

use std::collections::BTreeMap;

use inroads_sim::{
    Shape,
    rigid::{
        Articulated, Axis, Configuration, Joint, Limits, Link, Mass, Model, Part, Physics, Pose,
        Surroundings, Vector, ant,
    },
};
use rapier3d::prelude::{ColliderBuilder, MassProperties, Matrix};

const ANT: &str = include_str!("../../tests/fixtures/mjcf/ant.xml");
const BEETLE: &str = include_str!("../../tests/fixtures/mjcf/beetle.xml");
const BEETLE_IN_MUJOCO: &str = include_str!("../../tests/fixtures/mjcf/beetle.txt");

/// World poses of a model's links when all joints are at zero.
fn poses(model: &Model) -> Vec<Pose> {
    let mut poses: Vec<Pose> = Vec::new();
    for link in &model.links {
        poses.push(link.parent.map_or(Pose::IDENTITY, |parent| poses[parent]) * link.place);
    }
    poses
}

/// A solid's mass and inertia as Rapier has it, in the link's frame.
fn weigh(part: &Part) -> MassProperties {
    let collider = match &part.shape {
        Shape::Ball { radius } => ColliderBuilder::ball(*radius),
        Shape::Capsule { from, to, radius } => ColliderBuilder::capsule_from_endpoints(*from, *to, *radius),
        Shape::Cuboid { half } => ColliderBuilder::cuboid(half.x, half.y, half.z),
        // Rapier's cylinders lie along y.
        Shape::Cylinder { half_height, radius } => ColliderBuilder::cylinder(*half_height, *radius),
        Shape::Hull { points } => ColliderBuilder::convex_hull(points).expect("a hull"),
    };
    let upright = match part.shape {
        Shape::Cylinder { .. } => Pose::rotation(Vector::X * std::f32::consts::FRAC_PI_2),
        _ => Pose::IDENTITY,
    };
    collider.density(part.density).build().mass_properties().transform_by(&(part.pose * upright))
}

/// Mass, centre of mass in the world, and inertia about it along the world's axes.
fn spread(solids: &[Part], mass: Option<&Mass>, pose: &Pose) -> (f32, Vector, Matrix) {
    let whole = match mass {
        Some(Mass { mass, place, inertia }) => {
            MassProperties::with_principal_inertia_frame(place.translation, *mass, *inertia, place.rotation)
        }
        None => solids.iter().map(weigh).sum::<MassProperties>(),
    };
    let turn = Matrix::from_quat(pose.rotation);
    let inertia = turn * whole.reconstruct_inertia_matrix() * turn.transpose();
    (whole.mass(), pose.transform_point(whole.local_com), inertia)
}

fn assert_near(ours: &[f32], theirs: &[f32], tolerance: f32, what: &str) {
    let near = ours.len() == theirs.len() && ours.iter().zip(theirs).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{what}:\n{ours:?}\n{theirs:?}");
}

#[test]
fn mass_place_and_joints_are_what_mujoco_makes_of_the_file() {
    let model = Model::from_mjcf(BEETLE).unwrap();
    let poses = poses(&model);
    let named = |name: &str| model.links.iter().position(|link| link.name == name).expect(name);
    let mut joints = BTreeMap::new();
    for (link, pose) in model.links.iter().zip(&poses) {
        if let Joint::Hinge(axis) | Joint::Slide(axis) = &link.joint {
            joints.insert(joints.len(), (axis, pose));
        }
    }
    let mut seen = [0, 0];
    for row in BEETLE_IN_MUJOCO.lines().filter(|row| !row.starts_with('#')) {
        let words: Vec<_> = row.split_whitespace().collect();
        let (kind, name) = (words[0], words[1]);
        let numbers: Vec<f32> = words[2..].iter().map(|word| word.parse().unwrap()).collect();
        if kind == "body" {
            let link = named(name);
            let (solids, mass) = (&model.links[link].solids, model.links[link].mass.as_ref());
            let (mass, centre, inertia) = spread(solids, mass, &poses[link]);
            assert_near(&[mass], &numbers[..1], 1e-5, name);
            assert_near(&centre.to_array(), &numbers[1..4], 1e-5, name);
            let i = inertia;
            let six = [i.x_axis.x, i.y_axis.y, i.z_axis.z, i.x_axis.y, i.x_axis.z, i.y_axis.z];
            assert_near(&six, &numbers[4..10], 1e-6, name);
            seen[0] += 1;
        } else {
            let (axis, pose) = joints[&seen[1]];
            assert_near(&(pose.rotation * axis.axis).to_array(), &numbers[..3], 1e-5, name);
            assert_near(&pose.transform_point(axis.anchor).to_array(), &numbers[3..6], 1e-5, name);
            assert_near(&axis.range.expect("all are limited"), &numbers[6..8], 1e-6, name);
            seen[1] += 1;
        }
    }
    assert_eq!(seen, [14, 18]);
}

#[test]
fn joints_motors_and_contacts_are_those_of_the_default_classes() {
    let model = Model::from_mjcf(BEETLE).unwrap();
    assert_eq!((model.name.as_str(), model.links[0].joint.clone()), ("beetle", Joint::Free));
    let gears: Vec<_> = model.actuators.iter().map(|motor| motor.gear).collect();
    assert_eq!(gears, [8.0, 8.0, 80.0].repeat(6));
    let Joint::Slide(reach) = &model.links[model.actuators[2].link].joint else { panic!("a slide") };
    assert_eq!((reach.damping, reach.armature, reach.friction), (30.0, 0.5, 0.1));
    let Joint::Hinge(lift) = &model.links[model.actuators[1].link].joint else { panic!("a hinge") };
    assert_eq!((lift.damping, lift.armature, lift.friction), (0.4, 0.02, 0.0));
    let solids: Vec<_> = model.links.iter().flat_map(|link| &link.solids).collect();
    assert!(solids.iter().all(|solid| solid.solid && solid.friction == 0.8));
    let through = Model::from_mjcf(&BEETLE.replace("friction=\"0.8\"", "contype=\"0\"")).unwrap();
    assert!(
        through.links.iter().flat_map(|link| &link.solids).all(|part| !part.solid && part.friction == 1.0)
    );
}

#[test]
fn a_body_with_two_joints_is_two_links() {
    let model = Model::from_mjcf(BEETLE).unwrap();
    let lift = model.links.iter().position(|link| link.name == "thigh_4").unwrap();
    let turn = model.links[lift].parent.unwrap();
    assert_eq!(model.links[turn].name, "thigh_4, joint 1");
    assert!(model.links[turn].solids.is_empty() && !model.links[lift].solids.is_empty());
    assert_eq!(model.links[lift].place, Pose::IDENTITY);
}

/// A file with one body, two joints and a motor, in which one thing is replaced by another.
fn with(what: &str, instead: &str) -> String {
    let text = "<mujoco>
  <compiler angle=\"radian\"/>
  <default>
    <default class=\"arm\"/>
  </default>
  <worldbody>
    <body name=\"cart\" childclass=\"arm\">
      <joint name=\"rail\" type=\"slide\" axis=\"1 0 0\" range=\"-1 1\"/>
      <geom name=\"hull\" type=\"box\" size=\"0.2 0.1 0.1\"/>
      <body name=\"pole\">
        <joint name=\"swing\" axis=\"0 1 0\" damping=\"0.1\"/>
        <geom type=\"capsule\" fromto=\"0 0 0 0 0 1\" size=\"0.05\"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint=\"rail\" gear=\"10\" ctrlrange=\"-1 1\"/>
  </actuator>
</mujoco>";
    assert!(text.contains(what), "{what}");
    text.replacen(what, instead, 1)
}

#[test]
fn what_is_not_understood_is_refused_with_the_place_and_the_mend() {
    Model::from_mjcf(&with("<mujoco>", "<mujoco>")).unwrap();
    #[rustfmt::skip]
    let table = [
        // XML.
        ("</actuator>", "", "line 19, column 1, text: this is no well-formed XML"),
        ("size=\"0.05\"", "size=0.05", "line 12, column"),
        ("<mujoco>", "", "line 3, column 3, text: this is no well-formed XML"),
        // Words that are not in the book, or that we cannot follow.
        ("damping=", "dampign=", "line 11, column 42, <joint name=\"swing\">: the attribute \"dampign\""),
        ("<geom type=\"capsule\"", "<gaom type=\"capsule\"", "<gaom> in body \"pole\": this is not understood in <body>"),
        ("class=\"arm\"/>\n  </default>", "class=\"arm\"><position/></default></default>", "only motors"),
        ("</worldbody>", "</worldbody><equality><weld body1=\"cart\"/></equality>", "<equality>"),
        ("</worldbody>", "</worldbody><tendon><fixed/></tendon>", "a motor of its own"),
        ("</worldbody>", "</worldbody><include file=\"more.xml\"/>", "other files are not read"),
        ("</worldbody>", "</worldbody><option viscosity=\"0.1\"/>", "\"viscosity\""),
        ("</worldbody>", "</worldbody><option><flag contact=\"disable\"/></option>", "<flag>"),
        ("angle=\"radian\"", "settotalmass=\"1\"", "\"settotalmass\""),
        ("angle=\"radian\"", "coordinate=\"global\"", "write one of: local"),
        ("name=\"pole\"", "mocap=\"true\"", "\"mocap\""),
        ("<default>", "<default class=\"all\">", "outermost default class"),
        ("<default class=\"arm\"/>", "<default class=\"arm\"/><default/>", "give it a class"),
        ("childclass=\"arm\"", "childclass=\"leg\"", "<body name=\"cart\">: childclass is \"leg\""),
        ("<default class=\"arm\"/>", "<default class=\"arm\"><geom pos=\"0 0 1\"/></default>", "give each geom its own"),
        // Values.
        ("damping=\"0.1\"", "damping=\"nan\"", "damping is \"nan\"; write a finite number"),
        ("damping=\"0.1\"", "damping=\"-1\"", "none of these can be negative"),
        ("axis=\"0 1 0\"", "axis=\"0 1\"", "axis is \"0 1\"; write 3 finite numbers"),
        ("axis=\"0 1 0\"", "axis=\"0 0 0\"", "<joint name=\"swing\">: its axis has no direction"),
        ("axis=\"0 1 0\"", "type=\"ball\"", "ball joints are not understood; write three hinges"),
        ("axis=\"0 1 0\"", "type=\"bell\"", "write one of: free, hinge, slide, ball"),
        ("axis=\"0 1 0\" damping=\"0.1\"", "type=\"free\"", "only the body that hangs in the world can be free"),
        ("type=\"slide\" axis=\"1 0 0\" range=\"-1 1\"", "type=\"free\" armature=\"1\"", "write <freejoint/>"),
        ("axis=\"0 1 0\"", "stiffness=\"3\"", "springs are not understood"),
        ("axis=\"0 1 0\"", "ref=\"3\"", "its zero is not at 0"),
        ("range=\"-1 1\"", "range=\"1 -1\"", "write the lower end first"),
        ("range=\"-1 1\"", "limited=\"true\"", "give it a range"),
        ("name=\"swing\"", "name=\"rail\"", "another joint has this name"),
        ("size=\"0.2 0.1 0.1\"", "size=\"0.2 0.1\"", "<geom name=\"hull\">: its size needs 3 numbers above 0"),
        ("size=\"0.05\"", "size=\"-0.05\"", "its size needs 1 numbers above 0"),
        ("size=\"0.05\"", "size=\"0.05\" density=\"-1\"", "neither can be negative"),
        ("fromto=\"0 0 0 0 0 1\"", "fromto=\"0 0 0 0 0 0\"", "its two ends are one point"),
        ("fromto=\"0 0 0 0 0 1\"", "fromto=\"0 0 0 0 0 1\" pos=\"0 0 0\"", "leave one of the two away"),
        ("type=\"box\"", "type=\"ellipsoid\"", "make it a capsule"),
        ("type=\"box\"", "type=\"mesh\" mesh=\"m\"", "meshes and fields"),
        ("type=\"box\"", "type=\"box\" contype=\"-1\"", "write a whole number"),
        ("<geom name=\"hull\"", "<inertial mass=\"1\" diaginertia=\"1 1 3\"/><geom", "none greater than the other two"),
        ("<geom type=\"capsule\" fromto=\"0 0 0 0 0 1\" size=\"0.05\"/>", "", "<body name=\"pole\">: it moves and has no mass"),
        ("angle=\"radian\"", "inertiafromgeom=\"false\"", "there is no <inertial>"),
        // The whole.
        ("</worldbody>", "<body name=\"tail\"/></worldbody>", "<body name=\"tail\">: this is a second body"),
        ("joint=\"rail\"", "joint=\"rial\"", "name one as its joint; there are: rail, swing"),
        ("joint=\"rail\"", "site=\"rail\"", "\"site\""),
        ("ctrlrange=\"-1 1\"", "", "its control has no limit"),
        ("ctrlrange=\"-1 1\"", "ctrlrange=\"0 1\"", "give it a symmetric ctrlrange"),
        ("<motor joint=\"rail\" gear=\"10\" ctrlrange=\"-1 1\"/>", "<general joint=\"rail\"/>", "only motors drive bodies"),
    ];
    for (what, instead, expected) in table {
        let text = with(what, instead);
        match Model::from_mjcf(&text) {
            Err(error) => assert!(error.to_string().contains(expected), "{instead}: {error}"),
            Ok(_) => panic!("{instead} was taken"),
        }
    }
    assert!(Model::from_mjcf("").unwrap_err().to_string().contains("line 1, column 1"));
    assert!(Model::from_mjcf("<robot/>").unwrap_err().to_string().contains("must be <mujoco>"));
    assert!(Model::from_mjcf("<mujoco/>").unwrap_err().to_string().contains("there is no <body>"));
}

#[test]
fn what_a_world_has_of_its_own_is_left_out() {
    let more = "<geom type=\"plane\" size=\"1 1 1\"/><light/><camera name=\"c\"/><site name=\"s\"/>";
    let plain = Model::from_mjcf(&with("<worldbody>", "<worldbody>")).unwrap();
    let full = with("<worldbody>", &format!("<option timestep=\"0.01\"/><worldbody>{more}"));
    assert_eq!(Model::from_mjcf(&full).unwrap(), plain);
    assert!(Model::from_mjcf(ANT).unwrap().links[0].place.translation == Vector::new(0.0, 0.0, 0.75));
}

/// All numbers of a link.
fn numbers(link: &Link) -> Vec<f32> {
    let pose =
        |pose: &Pose| [pose.translation.to_array().to_vec(), pose.rotation.to_array().to_vec()].concat();
    let mut all = pose(&link.place);
    if let Joint::Hinge(Axis { axis, anchor, range, damping, armature, friction }) = &link.joint {
        all.extend([axis.to_array(), anchor.to_array(), [*damping, *armature, *friction]].concat());
        all.extend(range.unwrap_or([f32::MIN, f32::MAX]));
    }
    let (mass, centre, inertia) = spread(&link.solids, link.mass.as_ref(), &Pose::IDENTITY);
    all.push(mass);
    all.extend(centre.to_array());
    all.extend(inertia.to_cols_array());
    all.extend(link.solids.iter().flat_map(|part| [part.density, part.friction, f32::from(part.solid)]));
    all
}

#[test]
fn the_ant_of_a_file_is_our_ant() {
    let (file, ours) = (Model::from_mjcf(ANT).unwrap(), ant::model(ant::THESIS.gear));
    assert_eq!(
        (&file.name, file.links.len(), &file.actuators),
        (&ours.name, ours.links.len(), &ours.actuators)
    );
    for (file, ours) in file.links.iter().zip(&ours.links) {
        let kind = std::mem::discriminant::<Joint>;
        assert_eq!((file.parent, kind(&file.joint)), (ours.parent, kind(&ours.joint)), "{}", ours.name);
        assert_near(&numbers(file), &numbers(ours), 1e-6, &ours.name);
        // Shapes, of which the above sees only the masses.
        for (file, ours) in file.solids.iter().zip(&ours.solids) {
            match (&file.shape, &ours.shape) {
                (Shape::Ball { radius: a }, Shape::Ball { radius: b }) => assert_eq!(a, b),
                (Shape::Capsule { from, to, radius }, Shape::Capsule { from: f, to: t, radius: r }) => {
                    assert!((*from, *radius) == (*f, *r) && to.distance(*t) < 1e-6);
                }
                shapes => panic!("{shapes:?}"),
            }
        }
    }
}

#[test]
fn the_ant_of_a_file_walks_as_our_ant_does() {
    let walk = |model: Model| {
        let around = Surroundings { floor: Some(ant::THESIS.floor), walls: None };
        let mut world = Articulated::new(&[model], around, ant::THESIS.physics.clone()).unwrap();
        for step in 0..20 {
            let controls: Vec<_> =
                (0..8).map(|joint| (0.7 * step as f32 + 1.3 * joint as f32).sin()).collect();
            world.step(&controls).unwrap();
        }
        world.configuration().clone()
    };
    let (file, ours) = (walk(Model::from_mjcf(ANT).unwrap()), walk(ant::model(ant::THESIS.gear)));
    assert_near(&file.q, &ours.q, 1e-3, "positions after 2 s");
    assert!(ours.q[0].hypot(ours.q[1]) > 0.05, "it walked: {:?}", ours.q);
}

#[test]
fn a_body_from_a_file_stands_as_it_stands_in_mujoco() {
    let physics =
        Physics { calls: 10, substeps: 4, prediction: 0.02, limits: Limits::Hard, ..ant::THESIS.physics };
    let around = Surroundings { floor: Some(0.0), walls: None };
    let mut world = Articulated::new(&[Model::from_mjcf(BEETLE).unwrap()], around, physics).unwrap();
    // Thighs down, shins out, for a second.
    for _ in 0..10 {
        world.step(&[0.0, 1.0, 1.0].repeat(6)).unwrap();
    }
    let Configuration { q, .. } = world.configuration();
    // MuJoCo 4.0: height 0.482 m, level, lifts 0.604 rad and reaches 0.052 m (its limits give a little).
    assert_near(&q[2..6], &[0.482, (1.0 - q[6] * q[6]).sqrt(), 0.0, 0.0], 5e-3, "the thorax");
    for leg in q[7..].chunks(3) {
        assert_near(&leg[1..], &[0.604, 0.052], 5e-3, "lift and reach of a leg");
    }
}
