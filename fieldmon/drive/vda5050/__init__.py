"""Live by VDA 5050: fieldmon is the fleet control, a robot drives and tells, over MQTT."""
