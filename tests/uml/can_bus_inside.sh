ip link add vcan0 type vcan && ip link set vcan0 mtu 72 && ip link set vcan0 up
ip link add vcan1 type vcan && ip link set vcan1 mtu 16 && ip link set vcan1 up
"$GAITD_BUILD/tests/can_bus_test" --gtest_brief=1
