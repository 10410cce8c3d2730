// A peer on Fast DDS, which shares neither code nor codec with the station: names, types and policies are as ROS 2
// makes them, the bytes are Fast CDR's.
//
//   peer DOMAIN echo            says the text of /ping twice on /pong, /joints/in turned round on /joints/out, and
//                               what it hears on /kept/in on /kept/out, which late joiners get as well
//   peer DOMAIN serve           is where rmw_fastrtps would have a server of /add_two_ints, and prints what reaches it
//   peer DOMAIN ask             is where rmw_fastrtps would have a client of it, asks ten times a second, and prints
//                               what it is answered
//   peer DOMAIN robot NAME      is robot_1 or robot_2 of the station with two robots and a buffer
//
// It stays on the loopback interface, prints a line per event and ends with its standard input.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

using namespace eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using Clock = std::chrono::steady_clock;

// The messages, with their fields in the order of their definitions.

struct Text {
  static constexpr const char* type = "std_msgs::msg::dds_::String_";
  std::string data;
  template <class Visit> void fields(Visit&& each) { each(data); }
};

struct Joints {
  static constexpr const char* type = "sensor_msgs::msg::dds_::JointState_";
  int32_t seconds = 0;
  uint32_t nanoseconds = 0;
  std::string frame;
  std::vector<std::string> names;
  std::vector<double> position, velocity, effort;
  template <class Visit> void fields(Visit&& each) {
    each(seconds), each(nanoseconds), each(frame), each(names), each(position), each(velocity), each(effort);
  }
};

struct RobotCommand {
  static constexpr const char* type = "buffer_msgs::msg::dds_::RobotCommand_";
  std::string target;
  bool close_gripper = false;
  template <class Visit> void fields(Visit&& each) { each(target), each(close_gripper); }
};

struct RobotState {
  static constexpr const char* type = "buffer_msgs::msg::dds_::RobotState_";
  std::string at;
  bool part_in_gripper = false, part_on_conveyor = false;
  template <class Visit> void fields(Visit&& each) { each(at), each(part_in_gripper), each(part_on_conveyor); }
};

struct AddRequest {
  static constexpr const char* type = "example_interfaces::srv::dds_::AddTwoInts_Request_";
  int64_t a = 0, b = 0;
  template <class Visit> void fields(Visit&& each) { each(a), each(b); }
};

struct AddResponse {
  static constexpr const char* type = "example_interfaces::srv::dds_::AddTwoInts_Response_";
  int64_t sum = 0;
  template <class Visit> void fields(Visit&& each) { each(sum); }
};

// How Fast DDS is told to send and take a message.
template <class Message> class MessageType : public TopicDataType {
 public:
  MessageType() {
    setName(Message::type);
    m_typeSize = 512;  // to begin with: the endpoints' memory grows
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }

  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
    payload->encapsulation = CDR_LE;
    payload->length = write(buffer, data);
    return true;
  }

  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    try {
      cdr.read_encapsulation();
      static_cast<Message*>(data)->fields([&](auto& field) { cdr.deserialize(field); });
    } catch (eprosima::fastcdr::exception::Exception& error) {
      std::cout << "malformed " << Message::type << std::endl;
      return false;
    }
    return true;
  }

  std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
    return [this, data] {
      FastBuffer growing;
      return write(growing, data);
    };
  }

  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }

 private:
  static uint32_t write(FastBuffer& buffer, void* data) {
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.serialize_encapsulation();
    static_cast<Message*>(data)->fields([&](auto& field) { cdr.serialize(field); });
    return static_cast<uint32_t>(cdr.getSerializedDataLength());
  }
};

class Peer {
 public:
  explicit Peer(int domain) {
    DomainParticipantQos qos;
    auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    loopback->interfaceWhiteList.push_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(loopback);
    rtps::Locator_t local;
    rtps::IPLocator::setIPv4(local, "127.0.0.1");
    qos.wire_protocol().builtin.initialPeersList.push_back(local);
    participant_ = DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    publisher_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  }

  ~Peer() {
    participant_->delete_contained_entities();
    DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  template <class Message> std::function<void(Message)> writer(const std::string& name, bool latched = false) {
    DataWriterQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = latched ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().depth = latched ? 1 : 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    DataWriter* made = publisher_->create_datawriter(topic<Message>(name), qos);
    return [made](Message message) { made->write(&message); };
  }

  template <class Message>
  void reader(const std::string& name, std::function<void(const Message&)> take, bool latched = false) {
    DataReaderQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = latched ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
    qos.history().depth = latched ? 1 : 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    DataReader* made = subscriber_->create_datareader(topic<Message>(name), qos);
    readers_.push_back([made, take] {
      Message message;
      SampleInfo info;
      while (made->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
        if (info.valid_data) take(message);
    });
  }

  // Take what comes, and let time pass, until the standard input ends.
  void live(const std::function<void()>& step) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (poll(&input, 1, 5) == 0) {
      for (auto& take : readers_) take();
      step();
    }
  }

 private:
  template <class Message> Topic* topic(const std::string& name) {
    TypeSupport(new MessageType<Message>).register_type(participant_);
    return participant_->create_topic(name, Message::type, TOPIC_QOS_DEFAULT);
  }

  DomainParticipant* participant_;
  Publisher* publisher_;
  Subscriber* subscriber_;
  std::vector<std::function<void()>> readers_;
};

void echo(Peer& peer) {
  auto pong = peer.writer<Text>("rt/pong");
  peer.reader<Text>("rt/ping", [=](const Text& heard) { pong({heard.data + heard.data}); });
  auto joints = peer.writer<Joints>("rt/joints/out");
  peer.reader<Joints>("rt/joints/in", [=](Joints heard) {
    std::reverse(heard.names.begin(), heard.names.end());
    for (auto& angle : heard.position) angle = -angle;
    joints(heard);
  });
  auto kept = peer.writer<Text>("rt/kept/out", true);
  peer.reader<Text>("rt/kept/in", [=](const Text& heard) { kept(heard); }, true);
  peer.live([] {});
}

void serve(Peer& peer) {
  auto answer = peer.writer<AddResponse>("rr/add_two_intsReply");
  peer.reader<AddRequest>("rq/add_two_intsRequest", [=](const AddRequest& request) {
    std::cout << "asked " << request.a << " + " << request.b << std::endl;
    answer({request.a + request.b});
  });
  peer.live([] {});
}

void ask(Peer& peer) {
  auto send = peer.writer<AddRequest>("rq/add_two_intsRequest");
  peer.reader<AddResponse>("rr/add_two_intsReply", [](const AddResponse& response) {
    std::cout << "answered " << response.sum << std::endl;
  });
  auto asked = Clock::now();
  peer.live([&] {
    if (Clock::now() - asked < std::chrono::milliseconds(100)) return;
    asked = Clock::now();
    send({2, 3});
  });
}

// A robot with a gripper between its own conveyor and the buffer. Parts come to the conveyor of robot_1, and leave that
// of robot_2, in their own time.
void robot(Peer& peer, const std::string& name) {
  const bool first = name == "robot_1";
  const std::string home = first ? "infeed" : "outfeed";
  RobotState state{home, false, first};
  RobotCommand command{home, false};
  auto now = Clock::now(), since = now, reported = now - std::chrono::seconds(1), changed = now;
  auto say = peer.writer<RobotState>("rt/" + name + "/state");
  peer.reader<RobotCommand>("rt/" + name + "/command", [&](const RobotCommand& heard) { command = heard; });
  peer.live([&] {
    now = Clock::now();
    const RobotState before = state;
    if (state.at == "between" && now - since > std::chrono::milliseconds(200)) state.at = command.target;
    else if (state.at != "between" && state.at != command.target) state.at = "between", since = now;
    if (command.close_gripper && !state.part_in_gripper) {
      if (first && state.at == home && state.part_on_conveyor) {
        state.part_in_gripper = true;
        state.part_on_conveyor = false;
      } else if (!first && state.at == "buffer") {
        state.part_in_gripper = true;
        std::cout << "taken from the buffer" << std::endl;
      }
    } else if (!command.close_gripper && state.part_in_gripper) {
      state.part_in_gripper = false;
      const char* fate = state.at == "between" ? "dropped" : state.at == "buffer" ? "put on the buffer" : "delivered";
      std::cout << fate << std::endl;
      if (!first && state.at == home) state.part_on_conveyor = true;
    } else if (state.part_on_conveyor != first && now - changed > std::chrono::milliseconds(500)) {
      state.part_on_conveyor = first;
    }
    if (state.part_on_conveyor != before.part_on_conveyor) changed = now;
    const bool new_state = state.at != before.at || state.part_in_gripper != before.part_in_gripper ||
                           state.part_on_conveyor != before.part_on_conveyor;
    if (new_state || now - reported > std::chrono::milliseconds(100)) say(state), reported = now;
  });
}

int main(int count, char** words) {
  const std::string role = count > 2 ? words[2] : "";
  if (!((role == "echo" || role == "serve" || role == "ask") && count == 3) && !(role == "robot" && count == 4)) {
    std::cerr << "peer DOMAIN echo | peer DOMAIN serve | peer DOMAIN ask | peer DOMAIN robot NAME" << std::endl;
    return 2;
  }
  Peer peer(std::stoi(words[1]));
  if (role == "echo") echo(peer);
  else if (role == "serve") serve(peer);
  else if (role == "ask") ask(peer);
  else robot(peer, words[3]);
  return 0;
}
