//! A peer on ros2-client, which shares neither code nor codec with the station.
//!
//!     peer DOMAIN echo             says the text of /ping twice on /pong, /joints/in turned round on /joints/out, and
//!                                  what it hears on /kept/in on /kept/out, which late joiners get as well
//!     peer DOMAIN serve MAPPING    adds two integers on /add_two_ints, and prints each request
//!     peer DOMAIN call MAPPING     asks /add_two_ints for 2 + 3 every 0.2 s, and prints each answer
//!
//! A MAPPING, `cyclone` or `enhanced`, says where the number of a request stands. The peer stays on the loopback
//! interface and ends with its standard input.

use std::io::{Read, stdin};
use std::net::{IpAddr, Ipv4Addr};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::{
    Context, Message, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher, QosProfile,
    ServiceMapping, ServiceTypeName, Subscription,
};
use rustdds::DomainParticipantBuilder;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Joints {
    seconds: i32,
    nanoseconds: u32,
    frame: String,
    names: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Request {
    a: i64,
    b: i64,
}
impl Message for Request {}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Response {
    sum: i64,
}
impl Message for Response {}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (domain, role) = match words.as_slice() {
        [domain, role @ ..] => (domain.parse().expect("a domain"), role),
        [] => panic!("peer DOMAIN echo | serve MAPPING | call MAPPING"),
    };
    let participant = DomainParticipantBuilder::new(domain)
        .with_only_networks([IpAddr::V4(Ipv4Addr::LOCALHOST)])
        .build()
        .expect("a participant");
    let context = Context::from_domain_participant(participant).expect("a context");
    let name = NodeName::new("/", "foreign").expect("a name");
    let mut node = context
        .new_node(name, NodeOptions::new().enable_rosout(false))
        .expect("a node");
    match role {
        ["echo"] => echo(&mut node),
        ["serve", mapping] => serve(&mut node, mapping_named(mapping)),
        ["call", mapping] => call(&mut node, mapping_named(mapping)),
        _ => panic!("no role {role:?}"),
    }
}

fn mapping_named(name: &str) -> ServiceMapping {
    match name {
        "cyclone" => ServiceMapping::Cyclone,
        "enhanced" => ServiceMapping::Enhanced,
        _ => panic!("no mapping {name}"),
    }
}

fn commands() -> QosProfile {
    QosProfile::publisher_default()
        .reliability_reliable(WhenFull::DEFAULT)
        .history(History::KeepLast { depth: 10 })
}

fn latched() -> QosProfile {
    commands()
        .durability(Durability::TransientLocal)
        .history(History::KeepLast { depth: 1 })
}

/// A publisher and a subscription of one type, on `names[0]` and `names[1]`.
fn both<T: Serialize + DeserializeOwned + 'static>(
    node: &mut Node,
    names: [(&str, &str); 2],
    type_name: (&str, &str),
    qos: &QosProfile,
) -> (Publisher<T>, Subscription<T>) {
    let [out, heard] = names.map(|(space, name)| {
        let name = Name::new(space, name).expect("a topic's name");
        let type_name = MessageTypeName::new(type_name.0, type_name.1);
        node.create_topic(&name, type_name, qos).expect("a topic")
    });
    (
        node.create_publisher(&out, Some(qos.clone()))
            .expect("a publisher"),
        node.create_subscription(&heard, Some(qos.clone()))
            .expect("a subscription"),
    )
}

/// Call `step` every five milliseconds until the standard input ends.
fn live(mut step: impl FnMut()) {
    let ended = Arc::new(AtomicBool::new(false));
    let noticed = ended.clone();
    thread::spawn(move || {
        let _ = stdin().read_to_end(&mut Vec::new());
        noticed.store(true, Ordering::Relaxed);
    });
    while !ended.load(Ordering::Relaxed) {
        step();
        thread::sleep(Duration::from_millis(5));
    }
}

fn echo(node: &mut Node) {
    let text = ("std_msgs", "String");
    let (pong, ping) = both::<String>(node, [("/", "pong"), ("/", "ping")], text, &commands());
    let joints = ("sensor_msgs", "JointState");
    let (turned, joints) = both::<Joints>(
        node,
        [("/joints", "out"), ("/joints", "in")],
        joints,
        &commands(),
    );
    let (kept, to_keep) =
        both::<String>(node, [("/kept", "out"), ("/kept", "in")], text, &latched());
    live(|| {
        while let Ok(Some((heard, _))) = ping.take() {
            pong.publish(heard.repeat(2)).expect("published");
        }
        while let Ok(Some((mut heard, _))) = joints.take() {
            heard.names.reverse();
            heard.position.iter_mut().for_each(|angle| *angle = -*angle);
            turned.publish(heard).expect("published");
        }
        while let Ok(Some((heard, _))) = to_keep.take() {
            kept.publish(heard).expect("published");
        }
    });
}

fn service() -> (Name, ServiceTypeName) {
    let name = Name::new("/", "add_two_ints").expect("a service's name");
    (
        name,
        ServiceTypeName::new("example_interfaces", "AddTwoInts"),
    )
}

fn serve(node: &mut Node, mapping: ServiceMapping) {
    let (name, type_name) = service();
    let server = node
        .create_server::<Request, Response>(mapping, &name, &type_name, commands(), commands())
        .expect("a server");
    live(|| {
        while let Ok(Some((id, request))) = server.receive_request() {
            println!("asked {} + {}", request.a, request.b);
            let sum = request.a + request.b;
            server
                .send_response(id, Response { sum })
                .expect("answered");
        }
    });
}

fn call(node: &mut Node, mapping: ServiceMapping) {
    let (name, type_name) = service();
    let client = node
        .create_client::<Request, Response>(mapping, &name, &type_name, commands(), commands())
        .expect("a client");
    let mut asked = Instant::now();
    live(|| {
        if asked.elapsed() > Duration::from_millis(200) {
            asked = Instant::now();
            client.send_request(Request { a: 2, b: 3 }).expect("asked");
        }
        while let Ok(Some((_, response))) = client.receive_response() {
            println!("answered {}", response.sum);
        }
    });
}
