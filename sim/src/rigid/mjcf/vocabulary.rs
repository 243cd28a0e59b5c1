//! Looks a text over by the [`book`](super::book), and keeps where things stand.

use std::collections::BTreeSet;

use roxmltree::{Attribute, Document, Node};

use super::{
    MjcfError,
    book::{
        ELEMENTS, POSE,
        Value::{self, Class, LeftOut, Mask, Numbers, Text, Words},
    },
};

/// Where an element stands, and what it is called in messages.
#[derive(Clone, Debug)]
pub(super) struct Place {
    line: u32,
    column: u32,
    element: String,
}

impl Place {
    fn of(node: Node<'_, '_>) -> Self {
        let at = node.document().text_pos_at(node.range().start);
        let name = match node.attribute("name").or_else(|| node.attribute("joint")) {
            Some(name) => format!(" name={name:?}"),
            None => String::new(),
        };
        let body = node.ancestors().skip(1).find(|above| above.has_tag_name("body"));
        let within = match body.and_then(|body| body.attribute("name")) {
            Some(body) if name.is_empty() => format!(" in body {body:?}"),
            _ => String::new(),
        };
        let element = format!("<{}{name}>{within}", node.tag_name().name());
        Self { line: at.row, column: at.col, element }
    }

    pub(super) fn error(&self, fault: impl Into<String>, mend: impl Into<String>) -> MjcfError {
        let (line, column, element) = (self.line, self.column, self.element.clone());
        MjcfError { line, column, element, fault: fault.into(), mend: mend.into() }
    }
}

/// The places of what becomes part of a model, in the order in which the parser lists it.
#[derive(Debug)]
pub(super) struct Places {
    /// The first is the world's.
    pub(super) bodies: Vec<BodyPlaces>,
    pub(super) motors: Vec<Place>,
}

/// The places of a body and of what it is made of.
#[derive(Debug)]
pub(super) struct BodyPlaces {
    pub(super) body: Place,
    pub(super) joints: Vec<Place>,
    pub(super) geoms: Vec<Place>,
}

/// Looks a text over: all that is in it is in the book, numbers are numbers, classes exist.
pub(super) fn check(xml: &str) -> Result<Places, MjcfError> {
    let document = Document::parse(xml).map_err(|why| MjcfError {
        line: why.pos().row,
        column: why.pos().col,
        element: "text".to_owned(),
        fault: format!("this is no well-formed XML: {why}"),
        mend: "mend it there, or a little before".to_owned(),
    })?;
    let root = document.root_element();
    if !root.has_tag_name("mujoco") {
        return Err(Place::of(root).error("this is no MJCF", "the outermost element must be <mujoco>"));
    }
    let classes: BTreeSet<&str> = root
        .descendants()
        .filter(|node| node.has_tag_name("default"))
        .filter_map(|node| node.attribute("class"))
        .chain(["main"])
        .collect();
    // The parser would read these files wherever it meets them.
    if let Some(node) =
        root.descendants().find(|node| node.has_tag_name("include") || node.has_tag_name("model"))
    {
        return Err(Place::of(node).error("other files are not read", "put what it names into this text"));
    }
    look(root, &classes)?;
    Ok(places(root))
}

fn look(node: Node<'_, '_>, classes: &BTreeSet<&str>) -> Result<(), MjcfError> {
    let tag = node.tag_name().name();
    let Some(known) = ELEMENTS.iter().find(|known| known.tag == tag) else {
        return Err(refused(node));
    };
    for attribute in node.attributes() {
        let posed = matches!(tag, "body" | "frame" | "geom" | "inertial");
        let rows = known.attributes.iter().chain(if posed { POSE } else { &[] });
        let Some((_, value)) = rows.into_iter().find(|(name, _)| *name == attribute.name()) else {
            return Err(at(node, &attribute).error(
                format!("the attribute {:?} is not understood", attribute.name()),
                "take it away, if the body can do without",
            ));
        };
        admit(node, &attribute, *value, classes)?;
    }
    particular(node)?;
    for child in node.children().filter(Node::is_element) {
        let name = child.tag_name().name();
        if known.children.contains(&name) {
            look(child, classes)?;
        } else if !known.passed.contains(&name) {
            return Err(refused(child));
        }
    }
    Ok(())
}

/// Rules that no table holds.
fn particular(node: Node<'_, '_>) -> Result<(), MjcfError> {
    let has = |name: &str| node.has_attribute(name);
    let posed = POSE.iter().any(|(name, _)| has(name));
    let within = |tag| node.parent_element().is_some_and(|parent| parent.has_tag_name(tag));
    let fault = match node.tag_name().name() {
        "default" if within("mujoco") && node.attribute("class").is_some_and(|class| class != "main") => {
            Some((
                "the outermost default class has a name of its own",
                "call it \"main\", or leave its name away",
            ))
        }
        "default" if !within("mujoco") && !has("class") => {
            Some(("a default class within another has no name", "give it a class"))
        }
        "geom" if within("default") && (posed || has("fromto")) => {
            Some(("a default class gives geoms a place", "give each geom its own pos, quat or fromto"))
        }
        "geom" if has("fromto") && posed => {
            Some(("it has both a fromto and a place", "leave one of the two away"))
        }
        _ => None,
    };
    match fault {
        Some((fault, mend)) => Err(Place::of(node).error(fault, mend)),
        None => Ok(()),
    }
}

/// Checks one attribute's value.
fn admit(
    node: Node<'_, '_>,
    attribute: &Attribute<'_, '_>,
    value: Value,
    classes: &BTreeSet<&str>,
) -> Result<(), MjcfError> {
    let (name, text) = (attribute.name(), attribute.value());
    let fault = |mend: String| Err(at(node, attribute).error(format!("{name} is {text:?}"), mend));
    match value {
        Text | LeftOut => Ok(()),
        Words(words) if words.contains(&text) => Ok(()),
        Words(words) => fault(format!("write one of: {}", words.join(", "))),
        Mask if text.trim().parse::<u32>().is_ok() => Ok(()),
        Mask => fault("write a whole number that is not negative".to_owned()),
        Class if classes.contains(text) => Ok(()),
        Class => fault("name a default class that there is".to_owned()),
        Numbers(least, most) => {
            let numbers: Vec<_> = text.split_ascii_whitespace().map(str::parse::<f64>).collect();
            let finite = numbers.iter().all(|number| number.as_ref().is_ok_and(|x| x.is_finite()));
            match (least, most) {
                _ if finite && (least..=most).contains(&numbers.len()) => Ok(()),
                (1, 1) => fault("write a finite number".to_owned()),
                _ if least == most => fault(format!("write {most} finite numbers")),
                _ => fault(format!("write {least} to {most} finite numbers")),
            }
        }
    }
}

/// The place of an attribute, with its element's name.
fn at(node: Node<'_, '_>, attribute: &Attribute<'_, '_>) -> Place {
    let start = node.document().text_pos_at(attribute.range().start);
    Place { line: start.row, column: start.col, ..Place::of(node) }
}

/// What to do about an element that is not understood.
fn refused(node: Node<'_, '_>) -> MjcfError {
    let mend = match node.tag_name().name() {
        "equality" => "bodies are trees: make a fixed joint of a weld, and do without other constraints",
        "tendon" => "drive each joint with a motor of its own",
        "pair" => "let contype and conaffinity say what touches the floor",
        "position" | "velocity" | "intvelocity" | "damper" | "general" | "muscle" | "cylinder"
        | "adhesion" => "only motors drive bodies: write <motor> with the torque of control 1 as gear",
        "flag" => "physics cannot be switched off in parts; leave it away",
        "attach" | "replicate" | "composite" | "flexcomp" => "write its bodies out",
        _ => "take it away, if the body can do without",
    };
    let parent = node.parent_element().map_or("", |parent| parent.tag_name().name());
    Place::of(node).error(format!("this is not understood in <{parent}>"), mend)
}

fn places(root: Node<'_, '_>) -> Places {
    let children = |tag| root.children().filter(move |node| Node::has_tag_name(node, tag));
    let mut bodies = vec![BodyPlaces { body: Place::of(root), joints: Vec::new(), geoms: Vec::new() }];
    for world in children("worldbody") {
        collect(world, 0, &mut bodies);
    }
    let motors = children("actuator").flat_map(|block| block.children().filter(Node::is_element));
    Places { bodies, motors: motors.map(Place::of).collect() }
}

/// Lists bodies parents first, in the order of the text, as the parser does; frames belong to their body.
fn collect(node: Node<'_, '_>, body: usize, bodies: &mut Vec<BodyPlaces>) {
    for child in node.children().filter(Node::is_element) {
        match child.tag_name().name() {
            "joint" | "freejoint" => bodies[body].joints.push(Place::of(child)),
            "geom" => bodies[body].geoms.push(Place::of(child)),
            "frame" => collect(child, body, bodies),
            "body" => {
                let next = bodies.len();
                bodies.push(BodyPlaces { body: Place::of(child), joints: Vec::new(), geoms: Vec::new() });
                collect(child, next, bodies);
            }
            _ => {}
        }
    }
}
