// TimerServo: up to 8 servos by timer 1 of an AVR, with the calls of Arduino's Servo, which is not
// everywhere installed and takes more room. Pins 9 and 10 (Mega: 11, 12) lose analogWrite().
#ifndef TIMER_SERVO_H
#define TIMER_SERVO_H

#include <Arduino.h>

#ifndef TIMSK1
#error "TimerServo needs an AVR's timer 1: use <Servo.h>"
#endif

// The timer counts half microseconds (16 MHz / 8), from 0 again every 2.5 ms: longer than the
// longest pulse. Each servo has one such turn of eight, so its pulse comes every 20 ms.
class TimerServo {
 public:
  TimerServo() : pin_(0), ticks_(0), attached_(false) {
    if (count_ < turns) {
      all_[count_++] = this;
    }
  }

  void attach(uint8_t pin) {
    pinMode(pin, OUTPUT);
    pin_ = pin;
    attached_ = true;
    TCCR1A = 0;
    TCCR1B = _BV(WGM12) | _BV(CS11);  // up to OCR1A, clock / 8
    OCR1A = ticksPerTurn - 1;
    TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
  }

  // 0 to 180 degrees: a pulse of 544 to 2400 us, as from Arduino's Servo.
  void write(uint8_t degrees) {
    const uint16_t ticks = 2 * 544 + static_cast<uint32_t>(degrees) * (2 * (2400 - 544)) / 180;
    noInterrupts();  // two bytes, which an interrupt must not see half written
    ticks_ = ticks;
    interrupts();
  }

  static void beginPulse() {
    turn_ = (turn_ + 1) % turns;
    if (mayPulse()) {
      OCR1B = all_[turn_]->ticks_;
      digitalWrite(all_[turn_]->pin_, HIGH);
    }
  }
  static void endPulse() {
    if (mayPulse()) {
      digitalWrite(all_[turn_]->pin_, LOW);
    }
  }

 private:
  static constexpr uint8_t turns = 8;
  static constexpr uint16_t ticksPerTurn = 5000;

  static bool mayPulse() { return turn_ < count_ && all_[turn_]->attached_; }

  static TimerServo* all_[turns];
  static uint8_t count_;
  static uint8_t turn_;

  uint8_t pin_;
  volatile uint16_t ticks_;
  volatile bool attached_;
};

TimerServo* TimerServo::all_[TimerServo::turns];
uint8_t TimerServo::count_ = 0;
uint8_t TimerServo::turn_ = 0;

ISR(TIMER1_COMPA_vect) {
  TimerServo::beginPulse();
}
ISR(TIMER1_COMPB_vect) {
  TimerServo::endPulse();
}

#endif
