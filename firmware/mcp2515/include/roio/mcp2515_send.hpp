/// Mcp2515, sending: the queue, the chip's transmit buffers, and what became of each frame. Which
/// buffer comes next is mcp2515_order.hpp's. Included by mcp2515.hpp.
#ifndef ROIO_MCP2515_SEND_HPP
#define ROIO_MCP2515_SEND_HPP

#include <roio/mcp2515.hpp>

namespace roio {

ROIO_MCP2515_MEMBER(Status)::send(const Frame& frame, uint8_t token) {
  if (!is_sendable(frame)) {
    return Status::bad_argument;
  }
  return send(mcp2515::to_chip(frame), token);
}

ROIO_MCP2515_MEMBER(Status)::send(const Mcp2515Frame& frame, uint8_t token) {
  if (requested() != 0) {
    // Only the chip knows whether it has room by now.
    look();
    pump();
  }
  if (!running()) {
    return Status::no_chip;
  }
  if ((control_ & mcp2515::Control::only_listens) != 0) {
    return Status::wrong_mode;
  }
  return give_to_chip(frame, token) ? Status::ok : enqueue(frame, token);
}

/// Whether no frame waits that has to go first, and the chip has room; then it is there.
ROIO_MCP2515_MEMBER(bool)::give_to_chip(const Mcp2515Frame& frame, uint8_t token) {
  const bool goes_next =
      tx_queue().empty() || (is_urgent(frame) && !is_urgent(tx_queue().front().frame));
  return goes_next && load(frame, token);
}

ROIO_MCP2515_MEMBER(Status)::enqueue(const Mcp2515Frame& frame, uint8_t token) {
  if (tx_queue().full() || requests().aborting()) {
    return Status::full;
  }
  uint8_t place = tx_queue().size();
  tx_queue().commit();
  if (is_urgent(frame)) {
    while (place > 0) {
      const uint8_t ahead = static_cast<uint8_t>(place - 1U);
      if (is_urgent(tx_queue()[ahead].frame)) {
        break;
      }
      tx_queue()[place] = tx_queue()[ahead];
      place = ahead;
    }
  }
  tx_queue()[place].frame = frame;
  tx_queue()[place].keep(token);
  return Status::ok;
}

ROIO_MCP2515_MEMBER(void)::pump() {
  while (running() && !tx_queue().empty() &&
         load(tx_queue().front().frame, tx_queue().front().kept())) {
    tx_queue().pop();
  }
}

ROIO_MCP2515_MEMBER(bool)::load(const Mcp2515Frame& frame, uint8_t token) {
  const bool accepts = !requests().aborting();
  const uint8_t buffer =
      accepts ? order().choose(is_urgent(frame), requested()) : mcp2515::no_buffer;
  if (buffer == mcp2515::no_buffer) {
    return false;
  }
  const uint8_t length = !Traits::all_kinds  ? frame.bytes[4]  // that and no more
                         : frame.is_remote() ? uint8_t{0}
                                             : frame.length();
  {
    // With back_to_back from TXBnCTRL on, which is in front of the frame.
    Transaction transaction(port(), Traits::back_to_back ? static_cast<uint8_t>(Instruction::write)
                                                         : mcp2515::load_tx(buffer));
    if (Traits::back_to_back) {
      transaction.put(static_cast<uint8_t>(mcp2515::txbctrl(buffer)));
      transaction.put(order().level_of(buffer));
    }
    transaction.send(frame.bytes, static_cast<uint8_t>(Mcp2515Frame::head_length + length));
    // By RTS, never by writing TXREQ: errata item 5.
    transaction.release();
    transaction.restart(mcp2515::request_to_send(buffer));
  }
  status_ = static_cast<uint8_t>(status_ | QuickStatus::txreq(buffer));
  requests().keep(buffer, token);
  if (!Traits::reports_outcomes) {
    count(counters_.sent);
  }
  return true;
}

/// What follows from it that these transmissions have come to their end: bits TXREQ as in READ
/// STATUS.
ROIO_MCP2515_MEMBER(void)::settle(uint8_t ended) {
  if (Traits::reports_outcomes && ended != 0) {
    end(ended, TxOutcome::sent);
  }
  if (requests().aborting() && requested() == 0) {
    finish_abort();
  }
}

/// The chip has let go of all. What is to be sent all the same is still in its buffers.
ROIO_MCP2515_MEMBER(void)::finish_abort() {
  modify_register(Register::canctrl, mcp2515::Control::abort_all, 0);
  requests().set_aborting(false);
  const uint8_t again = requests().take_again();
  for (uint8_t buffer = mcp2515::urgent_buffer; again != 0 && buffer != 0; buffer >>= 1) {
    if ((again & QuickStatus::txreq(buffer)) != 0) {
      Transaction transaction(port(), mcp2515::request_to_send(buffer));
    }
  }
  status_ = static_cast<uint8_t>(status_ | again);
}

/// Reports what became of these requests: bits TXREQ as in READ STATUS.
/// @param outcome unknown, or what there is to be found out more about.
ROIO_MCP2515_MEMBER(void)::end(uint8_t ended, TxOutcome outcome) {
  uint8_t request = QuickStatus::txreq(mcp2515::urgent_buffer);
  for (uint8_t buffer = mcp2515::urgent_buffer; buffer != 0; buffer >>= 1, request >>= 2) {
    if ((ended & request) == 0) {
      continue;
    }
    if (outcome == TxOutcome::unknown || !may_end_otherwise()) {
      report(requests().token_of(buffer), outcome);
    } else {
      end_somehow(buffer);
    }
  }
}

/// A request ends by success, unless somebody has asked for less.
ROIO_MCP2515_MEMBER(bool)::may_end_otherwise() {
  return requests().aborting() || (control_ & mcp2515::Control::one_shot) != 0;
}

/// What the chip says of it. A frame that was taken back with others, and is not over, ends later:
/// finish_abort() sends it again.
ROIO_MCP2515_MEMBER(void)::end_somehow(uint8_t buffer) {
  const uint8_t token = requests().token_of(buffer);
  const TxOutcome outcome = outcome_of(buffer);
  if (outcome == TxOutcome::aborted && !traits().is_over(token)) {
    requests().add_again(QuickStatus::txreq(buffer));
  } else {
    report(token, outcome);
  }
}

ROIO_MCP2515_MEMBER(TxOutcome)::outcome_of(uint8_t buffer) {
  using mcp2515::TxControl;
  const bool one_shot = (control_ & mcp2515::Control::one_shot) != 0;
  const uint8_t control = read_register(mcp2515::txbctrl(buffer));
  if ((control & TxControl::fixed) != order().level_of(buffer)) {
    return TxOutcome::unknown;  // that is no answer of a chip that has ended this request
  }
  if ((control & (TxControl::lost_arbitration | TxControl::error)) != 0 && one_shot) {
    return TxOutcome::failed;
  }
  return (control & TxControl::aborted) != 0 ? TxOutcome::aborted : TxOutcome::sent;
}

ROIO_MCP2515_MEMBER(void)::report(uint8_t token, TxOutcome outcome) {
  if (outcome == TxOutcome::sent) {
    count(counters_.sent);
  } else if (outcome == TxOutcome::unknown) {
    count(counters_.unknown);
  } else {
    count(counters_.not_sent);
  }
  traits().on_outcome(token, outcome);
}

template <typename Port, uint8_t RxQueue, uint8_t TxQueue, typename Traits>
template <typename T>
void Mcp2515<Port, RxQueue, TxQueue, Traits>::abort() {
  static_assert(T::reports_outcomes, "abort() needs Traits::reports_outcomes");
  for (uint8_t left = tx_queue().size(); left != 0; --left) {
    const Waiting one = tx_queue().front();
    tx_queue().pop();
    if (traits().is_over(one.kept())) {
      report(one.kept(), TxOutcome::aborted);
    } else {
      tx_queue().next() = one;
      tx_queue().commit();
    }
  }
  if (running() && has_over_in_chip()) {
    requests().set_aborting(true);
    modify_register(Register::canctrl, mcp2515::Control::abort_all, mcp2515::Control::abort_all);
  }
}

ROIO_MCP2515_MEMBER(bool)::has_over_in_chip() {
  for (uint8_t buffer = mcp2515::urgent_buffer; buffer != 0; buffer >>= 1) {
    if ((requested() & QuickStatus::txreq(buffer)) != 0 &&
        traits().is_over(requests().token_of(buffer))) {
      return true;
    }
  }
  return false;
}

}  // namespace roio

#endif
