#include <algorithm>
#include <array>
#include <roio/serial_protocol.hpp>
#include <roio/serial_record.hpp>
#include <vector>

#include "frames.hpp"
#include "target.hpp"

namespace roio::fuzz {
namespace {

using serial::RecordReader;
using Bytes = std::vector<std::uint8_t>;
using Event = RecordReader::Event;

constexpr std::uint32_t open_session = 0x52AB0149;  // that of the seeds

struct Sink {
  void put(std::uint8_t offset, std::uint8_t byte) {
    require(offset < serial::max_record, "a record is written within the longest");
    bytes[offset] = byte;
  }
  std::array<std::uint8_t, serial::max_record> bytes{};
};
using Writer = serial::RecordWriter<Sink>;

template <typename Put>
Bytes record(std::uint32_t session, Put put) {
  Sink sink;
  Writer writer(sink, session);
  put(writer);
  const std::uint8_t length = writer.finish();
  return {sink.bytes.begin(), sink.bytes.begin() + length};
}

Bytes encode(const Bytes& body, std::uint32_t session) {
  return record(session, [&](Writer& writer) {
    for (const std::uint8_t byte : body) {
      writer.put(byte);
    }
  });
}

/// What is written of a body at once, as the bridge does.
Bytes encode_at_once(const Bytes& body, std::uint32_t session) {
  struct Reference {
    void put(std::uint8_t offset, std::uint8_t byte) { sink->put(offset, byte); }
    Sink* sink;
  };
  Sink sink;
  const std::uint8_t length = serial::write_record(Reference{&sink}, session, body.data(),
                                                   static_cast<std::uint8_t>(body.size()));
  return {sink.bytes.begin(), sink.bytes.begin() + length};
}

std::uint32_t session_of(const Bytes& body) {
  return serial::session_of(body[0], open_session);
}

Bytes encode_down(const Frame& frame, const Bytes& head) {
  return record(open_session, [&](Writer& writer) {
    serial::put_frame_down(writer, frame, head[serial::sequence_at], head[serial::life_at]);
  });
}

/// As put_frame_down(), with the time too.
Bytes encode_up(const Frame& frame, const Bytes& head) {
  return record(open_session, [&](Writer& writer) {
    writer.put32(tagged_id(frame));
    writer.put(head[serial::sequence_at]);
    writer.put(head[serial::time_at]);
    writer.put(head[serial::time_at + 1]);
    serial::put_payload(writer, frame.kind, frame.length, frame.data);
  });
}

/// A frame that is read, written again, must be the very record it was in.
void check_frame(const Bytes& body, std::uint8_t head) {
  Frame frame{};
  frame.id = 0xFFFFFFFF;
  const Frame untouched = frame;
  if (!serial::read_frame(body.data(), static_cast<std::uint8_t>(body.size()), head, frame)) {
    require(same(frame, untouched), "a body refused leaves the frame alone");
    return;
  }
  require(is_valid(frame) && frame.kind != FrameKind::error,
          "a frame read is one that a bus carries");
  require((head == serial::frame_head_down ? encode_down(frame, body) : encode_up(frame, body)) ==
              encode(body, open_session),
          "a frame comes back");
}

void check_frames(const Bytes& body) {
  check_frame(body, serial::frame_head_up);
  check_frame(body, serial::frame_head_down);
}

/// COBS as its authors have it, of what stands between two delimiters.
/// @return body and check; nothing when it is broken.
Bytes decoded(const Bytes& text) {
  Bytes bytes;
  for (auto at = text.begin(); at != text.end();) {
    if (at != text.begin()) {
      bytes.push_back(0);
    }
    if (text.end() - at < *at) {
      return {};
    }
    bytes.insert(bytes.end(), at + 1, at + *at);
    at += *at;
  }
  return bytes;
}

Event expected(const Bytes& text) {
  const std::size_t size = decoded(text).size();
  return text.empty() ? Event::none
         : size >= serial::min_body + serial::check_length &&
                 size <= serial::max_body + serial::check_length
             ? Event::record
             : Event::damaged;
}

void check_record(const RecordReader& reader, const Bytes& text) {
  const Bytes body(reader.body(), reader.body() + reader.length());
  require(std::equal(body.begin(), body.end(), decoded(text).begin()), "a body is what was sent");
  if (reader.is_intact(session_of(body))) {
    Bytes again = encode(body, session_of(body));
    again.pop_back();
    require(again == text, "what is intact comes back, byte for byte");
    check_frames(body);
  }
}

void check_stream(Bytes stream) {
  stream.push_back(serial::delimiter);
  RecordReader reader;
  Bytes text;
  for (const std::uint8_t byte : stream) {
    const Event event = reader.take(byte);
    if (byte != serial::delimiter) {
      require(event == Event::none, "what ends, ends at a delimiter");
      text.push_back(byte);
      continue;
    }
    require(event == expected(text), "a record is a record, damaged, or nothing");
    if (event == Event::record) {
      check_record(reader, text);
    }
    text.clear();
  }
  Event last = Event::none;
  for (const std::uint8_t byte : encode(Bytes(5, 0), open_session)) {
    last = reader.take(byte);
  }
  require(last == Event::record && reader.is_intact(open_session),
          "in step again after a delimiter");
}

/// What has ended, the bytes of it when it was a record, and whether it is one of the open session.
struct Ended {
  Event event;
  Bytes bytes;
  bool is_intact;
  friend bool operator==(const Ended&, const Ended&) = default;
};

Ended ended(const RecordReader& reader, Event event) {
  if (event != Event::record) {
    return {event, {}, false};
  }
  return {event, Bytes(reader.body(), reader.body() + reader.length() + serial::check_length),
          reader.is_intact(open_session)};
}

/// Bytes taken many at once are what they are one by one.
void check_pieces(const Bytes& stream, std::uint8_t piece) {
  RecordReader one_by_one;
  RecordReader at_once;
  at_once.expect(open_session);  // checks as they come
  std::vector<Ended> expected_ends;
  std::vector<Ended> ends;
  for (const std::uint8_t byte : stream) {
    const Event event = one_by_one.take(byte);
    if (event != Event::none) {
      expected_ends.push_back(ended(one_by_one, event));
    }
  }
  for (std::size_t at = 0; at < stream.size();) {
    auto count = static_cast<std::uint8_t>(std::min<std::size_t>(stream.size() - at, piece));
    const std::uint8_t given = count;
    const Event event = at_once.take(&stream[at], count);
    require(count == given || event != Event::none, "all are taken, unless something ends");
    require(count > 0 && count <= given, "some are taken, and no more than there are");
    require(event == Event::none || stream[at + count - 1U] == serial::delimiter,
            "what is taken ends where the record does");
    if (event != Event::none) {
      ends.push_back(ended(at_once, event));
    }
    at += count;
    at_once.expect(at % 3 == 0 ? open_session : static_cast<std::uint32_t>(at));  // at any place
  }
  require(ends == expected_ends, "bytes taken at once are what they are one by one");
}

/// Any body of a length that there is comes back from the line.
void check_body(const Bytes& body) {
  const Bytes line = encode(body, session_of(body));
  require(encode_at_once(body, session_of(body)) == line, "written at once, it is the same");
  require(line.size() == body.size() + serial::check_length + 2, "a record has 6 bytes more");
  RecordReader reader;
  for (const std::uint8_t byte : line) {
    const Event event = reader.take(byte);
    require((event == Event::record) == (byte == serial::delimiter), "one delimiter, at its end");
  }
  require(reader.is_intact(session_of(body)) && !reader.is_intact(session_of(body) + 1),
          "intact in its own session only");
  require(Bytes(reader.body(), reader.body() + reader.length()) == body, "a body comes back");
  check_frames(body);
}

}  // namespace

void check(std::string_view input) {
  const Bytes bytes(input.begin(), input.end());
  check_stream(bytes);
  // The first byte also says how long the pieces are.
  check_pieces(bytes, bytes.empty() ? 1 : std::max<std::uint8_t>(bytes[0], 1));
  check_pieces(bytes, 0xFF);
  if (bytes.size() >= serial::min_body && bytes.size() <= serial::max_body) {
    check_body(bytes);
  }
}

}  // namespace roio::fuzz
