// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/plant_runner.h"

#include <utility>

namespace gaitd::sim {

PlantRunner::PlantRunner(std::unique_ptr<Plant> plant, const std::vector<SensorFault>& faults,
                         int32_t clock, const GaitdHost* host)
    : plant_(std::move(plant)),
      faults_(faults),
      clock_(clock),
      host_(host),
      joint_count_(plant_->model().joint_count),
      body_count_(plant_->model().body_count),
      can_carry_(plant_->can_carry()) {
  sem_init(&wake_, 0, 0);
  last_command_.size = sizeof(last_command_);
  last_command_.joint_count = joint_count_;
  publish();
}

PlantRunner::~PlantRunner() {
  stop();
  sem_destroy(&wake_);
}

void PlantRunner::start() {
  if (lockstep() || thread_.joinable()) return;
  stopping_.store(false);
  thread_ = std::thread([this] { run(); });
}

void PlantRunner::stop() {
  if (!thread_.joinable()) return;
  stopping_.store(true);
  sem_post(&wake_);
  thread_.join();
}

void PlantRunner::reset() {
  const bool running = thread_.joinable();
  stop();
  while (sem_trywait(&wake_) == 0) {
  }
  GaitdDisturbance push;
  while (commands_.pop(&command_)) {
  }
  while (pushes_.pop(&push)) {
  }
  GaitdLoad load;
  while (loads_.pop(&load)) {
  }
  last_command_ = GaitdJointCommands{};
  last_command_.size = sizeof(last_command_);
  last_command_.joint_count = joint_count_;
  plant_->reset();
  faults_.reset();
  diverged_.store(false);
  publish();
  if (running) start();
}

void PlantRunner::publish() {
  GaitdSensors& sensors = output_.back().sensors;
  plant_->read(&sensors);
  faults_.apply(sensors.time, &sensors);
  plant_->read(&output_.back().truth);
  output_.publish();
}

bool PlantRunner::take() {
  if (output_.take()) unread_ = true;
  return unread_;
}

GaitdStatus PlantRunner::read(GaitdSensors* sensors) {
  if (diverged_.load(std::memory_order_acquire)) return GAITD_ERROR;
  if (!take()) return GAITD_NOT_READY;
  *sensors = output_.front().sensors;
  unread_ = false;
  return GAITD_OK;
}

GaitdStatus PlantRunner::write(const GaitdJointCommands& commands) {
  if (*check_commands(commands, joint_count_) != '\0') return GAITD_INVALID_ARGUMENT;
  if (lockstep()) {
    last_command_ = commands;
    return GAITD_OK;
  }
  if (!commands_.push(commands)) return GAITD_NOT_READY;
  sem_post(&wake_);
  return GAITD_OK;
}

GaitdStatus PlantRunner::advance() {
  if (!lockstep()) return GAITD_NOT_SUPPORTED;
  if (!plant_->advance(last_command_)) {
    diverged_.store(true, std::memory_order_release);
    return GAITD_ERROR;
  }
  publish();
  return GAITD_OK;
}

GaitdStatus PlantRunner::truth(GaitdTruth* truth) {
  take();
  *truth = output_.front().truth;
  return GAITD_OK;
}

GaitdStatus PlantRunner::disturb(const GaitdDisturbance& disturbance) {
  if (lockstep()) return plant_->disturb(disturbance) ? GAITD_OK : GAITD_INVALID_ARGUMENT;
  if (!Plant::valid(disturbance, body_count_)) return GAITD_INVALID_ARGUMENT;
  return pushes_.push(disturbance) ? GAITD_OK : GAITD_NOT_READY;
}

GaitdStatus PlantRunner::carry(const GaitdLoad& load) {
  if (!can_carry_) return GAITD_NOT_SUPPORTED;
  if (lockstep()) return plant_->carry(load) ? GAITD_OK : GAITD_INVALID_ARGUMENT;
  if (!Plant::valid(load, body_count_)) return GAITD_INVALID_ARGUMENT;
  return loads_.push(load) ? GAITD_OK : GAITD_NOT_READY;
}

void PlantRunner::run() {
  for (;;) {
    while (sem_wait(&wake_) != 0) {
    }
    if (stopping_.load()) return;
    if (commands_.pop(&command_)) run_one_period();
  }
}

void PlantRunner::run_one_period() {
  GaitdDisturbance push;
  while (pushes_.pop(&push)) plant_->disturb(push);
  GaitdLoad load;
  while (loads_.pop(&load)) plant_->carry(load);
  bool advanced = false;
  try {
    advanced = plant_->advance(command_);
  } catch (const std::exception& problem) {
    if (host_ != nullptr && host_->log != nullptr) {
      host_->log(host_->context, GAITD_LOG_ERROR, problem.what());
    }
  }
  if (advanced) {
    publish();
    return;
  }
  if (diverged_.exchange(true, std::memory_order_acq_rel)) return;
  if (host_ != nullptr && host_->log != nullptr) {
    host_->log(host_->context, GAITD_LOG_ERROR,
               "the simulation diverged (state not finite); reset it");
  }
}

}  // namespace gaitd::sim
