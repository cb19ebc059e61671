source /tmp/hB/tests/uml/uml.sh
uml_start_or_skip
uml_run can_bus_inside.sh 120
