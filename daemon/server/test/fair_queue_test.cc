// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/fair_queue.h"

#include <gtest/gtest.h>

#include <string>

namespace gaitd::daemon {
namespace {

// Everything that waits, in the order in which it is served.
std::string drain(FairQueue<char>* queue) {
  std::string out;
  while (auto item = queue->pop()) out += item->second;
  return out;
}

TEST(FairQueue, ServesClientsInTurns) {
  FairQueue<char> queue(10);
  for (const char c : std::string("aaaa")) queue.push(1, c);
  for (const char c : std::string("bb")) queue.push(2, c);
  EXPECT_EQ(queue.size(), 6u);
  EXPECT_EQ(drain(&queue), "ababaa");
  EXPECT_TRUE(queue.empty());
}

TEST(FairQueue, ServesFirstWhomItServedLongestAgo) {
  FairQueue<char> queue(10);
  queue.push(9, 'q');
  EXPECT_EQ(drain(&queue), "q");
  for (int i = 0; i < 4; ++i) {
    queue.push(1, 'a');
    queue.push(2, 'b');
  }
  queue.pop();
  queue.pop();
  queue.push(9, 'q');
  EXPECT_EQ(queue.pop()->second, 'q');
}

TEST(FairQueue, ANewClientDoesNotPassThoseThatHaveWaitedLongest) {
  FairQueue<char> queue(10);
  queue.push(1, 'a');
  queue.push(1, 'a');
  queue.pop();
  std::string served;
  for (std::uint64_t client = 2; client < 20; ++client) {
    queue.push(client, 'n');
    served += queue.pop()->second;
    queue.retire(client);
  }
  EXPECT_NE(served.find('a'), std::string::npos);
}

TEST(FairQueue, BoundsTheShareOfEachClient) {
  FairQueue<char> queue(2);
  EXPECT_TRUE(queue.push(1, 'a'));
  EXPECT_TRUE(queue.push(1, 'a'));
  EXPECT_FALSE(queue.has_room(1));
  EXPECT_FALSE(queue.push(1, 'a'));
  EXPECT_TRUE(queue.push(2, 'b'));
}

TEST(FairQueue, WhatIsPutBackComesFirst) {
  FairQueue<char> queue(10);
  queue.push(1, 'a');
  queue.push(1, 'b');
  auto item = queue.pop();
  queue.push_front(1, item->second);
  EXPECT_EQ(drain(&queue), "ab");
}

TEST(FairQueue, ARetiredClientIsServedAndForgotten) {
  FairQueue<char> queue(1);
  queue.push(1, 'a');
  queue.retire(1);
  EXPECT_FALSE(queue.has_room(1));
  const auto item = queue.pop();
  ASSERT_TRUE(item);
  queue.push_front(1, item->second);  // the rest of a batch
  EXPECT_EQ(drain(&queue), "a");
  EXPECT_TRUE(queue.has_room(1));
}

}  // namespace
}  // namespace gaitd::daemon
