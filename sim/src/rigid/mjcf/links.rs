//! From MJCF's bodies to links: one link a joint.

use std::collections::BTreeMap;

use mjcf_rs::body as mjcf;
use rapier3d::math::{Pose, Vector};

use super::{
    MjcfError, geoms,
    vocabulary::{BodyPlaces, Place, Places},
};
use crate::rigid::{Axis, Joint, Link};

/// The tree that hangs in the world.
pub(super) struct Tree {
    pub(super) links: Vec<Link>,
    /// The link of each joint that a motor may drive, by the joint's name.
    pub(super) joints: BTreeMap<String, usize>,
}

/// Reads the one tree of the file.
pub(super) fn read(file: &mjcf_rs::Model, places: &Places) -> Result<Tree, MjcfError> {
    let mut roots = file.bodies_iter().filter(|(_, entry)| entry.parent == Some(0)).map(|(id, _)| id);
    if roots.next().is_none() {
        return Err(places.bodies[0].body.error("there is no <body>", "write one into <worldbody>"));
    }
    if let Some(second) = roots.next() {
        return Err(places.bodies[second].body.error(
            "this is a second body beside the first, and a model is one tree",
            "put it into a file of its own",
        ));
    }
    let mut tree = Tree { links: Vec::new(), joints: BTreeMap::new() };
    // The last link of each MJCF body: what hangs on the body hangs on it.
    let mut last: Vec<Option<usize>> = vec![None];
    for (id, entry) in file.bodies_iter() {
        let parent = entry.parent.and_then(|parent| last[parent]);
        last.push(Some(add(&mut tree, file, id, parent, &places.bodies[id])?));
    }
    moving_links_have_mass(&tree.links, places, &last)?;
    Ok(tree)
}

/// Adds a body as a chain of links, one a joint, of which the last is made of the body's geoms. A body without
/// joints is one link that is fixed.
fn add(
    tree: &mut Tree,
    file: &mjcf_rs::Model,
    id: usize,
    parent: Option<usize>,
    places: &BodyPlaces,
) -> Result<usize, MjcfError> {
    let body = &file.bodies[id].body;
    let name = body.name.clone().unwrap_or_else(|| format!("body {id}"));
    let bare = |name: String, parent, place| Link {
        name,
        parent,
        place,
        joint: Joint::Fixed,
        solids: Vec::new(),
        mass: None,
    };
    let mut link = bare(name.clone(), parent, Pose::from(body.pose));
    for (index, (joint, place)) in body.joints.iter().zip(&places.joints).enumerate() {
        if index > 0 {
            let next = tree.links.len();
            let whole = link.name.clone();
            link.name = format!("{whole}, joint {index}");
            tree.links.push(std::mem::replace(&mut link, bare(whole, Some(next), Pose::IDENTITY)));
        }
        link.joint = read_joint(joint, file.compiler.autolimits, place)?;
        let free = link.joint == Joint::Free;
        if free && (parent.is_some() || body.joints.len() > 1) {
            return Err(place.error(
                "only the body that hangs in the world can be free, and by this joint alone",
                "take the other joints away, or this one",
            ));
        }
        let motorised = joint.name.as_ref().filter(|_| !free);
        if motorised.is_some_and(|name| tree.joints.insert(name.clone(), tree.links.len()).is_some()) {
            return Err(place.error("another joint has this name", "give each joint its own"));
        }
    }
    (link.solids, link.mass) = geoms::read(&file.compiler, body, places)?;
    tree.links.push(link);
    Ok(tree.links.len() - 1)
}

fn read_joint(joint: &mjcf::Joint, autolimits: bool, place: &Place) -> Result<Joint, MjcfError> {
    let fault = |what: String, mend: &str| Err(place.error(what, mend));
    match joint.type_ {
        mjcf::JointType::Ball => {
            return fault("ball joints are not understood".to_owned(), "write three hinges");
        }
        // As a <joint> it takes what the default class gives to hinges.
        mjcf::JointType::Free
            if [joint.damping, joint.armature, joint.frictionloss, joint.stiffness] != [0.0; 4] =>
        {
            return fault("a free body has no rotors, dampers or springs".to_owned(), "write <freejoint/>");
        }
        mjcf::JointType::Free => return Ok(Joint::Free),
        mjcf::JointType::Hinge | mjcf::JointType::Slide => {}
    }
    if joint.stiffness != 0.0 {
        return fault("springs are not understood".to_owned(), "leave the stiffness away");
    }
    if joint.ref_ != 0.0 {
        return fault("its zero is not at 0".to_owned(), "place the body where ref is 0, and leave ref away");
    }
    for (what, value) in
        [("damping", joint.damping), ("armature", joint.armature), ("frictionloss", joint.frictionloss)]
    {
        if value < 0.0 {
            return fault(format!("its {what} is {value}"), "none of these can be negative");
        }
    }
    let axis = Vector::from(joint.axis.map(|x| x as f32));
    if axis.length() < 1e-6 {
        return fault("its axis has no direction".to_owned(), "give an axis that is not 0 0 0");
    }
    let range = match (joint.limited.resolve(autolimits, joint.range.is_some()), joint.range) {
        (false, _) => None,
        (true, Some([low, high])) if low < high => Some([low as f32, high as f32]),
        (true, Some([low, high])) => {
            return fault(format!("its range is from {low} to {high}"), "write the lower end first");
        }
        (true, None) => return fault("it is limited, and has no range".to_owned(), "give it a range"),
    };
    let axis = Axis {
        axis: axis.normalize(),
        anchor: Vector::from(joint.pos.map(|x| x as f32)),
        range,
        damping: joint.damping as f32,
        armature: joint.armature as f32,
        friction: joint.frictionloss as f32,
    };
    Ok(match joint.type_ {
        mjcf::JointType::Slide => Joint::Slide(axis),
        _ => Joint::Hinge(axis),
    })
}

/// What moves must have mass, its own or that of what is fixed to it (MuJoCo's rule too).
fn moving_links_have_mass(links: &[Link], places: &Places, last: &[Option<usize>]) -> Result<(), MjcfError> {
    let mut heavy: Vec<bool> = links
        .iter()
        .map(|link| match &link.mass {
            Some(mass) => mass.mass > 0.0,
            None => link.solids.iter().any(|solid| solid.density > 0.0),
        })
        .collect();
    for (index, link) in links.iter().enumerate().rev() {
        if let (true, Joint::Fixed, Some(parent)) = (heavy[index], &link.joint, link.parent) {
            heavy[parent] = true;
        }
    }
    for (place, link) in places.bodies.iter().zip(last).filter_map(|(place, link)| Some((place, (*link)?))) {
        if links[link].joint != Joint::Fixed && !heavy[link] {
            return Err(place.body.error("it moves and has no mass", "give it a geom, or an <inertial>"));
        }
    }
    Ok(())
}
