"""Messages of a robot between two plants."""

ORDER = {
    "orderId": "day",
    "orderUpdateId": 1,
    "nodes": [
        {
            "nodeId": f"n{k}",
            "sequenceId": k,
            "released": k == 0,
            "nodePosition": {"x": 1.0, "y": 2.0, "mapId": "map", "allowedDeviationXY": 0.3},
            "actions": [
                {
                    "actionId": f"a{k}",
                    "actionType": "inspectPlant",
                    "blockingType": "HARD",
                    "actionParameters": [{"key": "plant", "value": 7}],
                }
            ],
        }
        for k in (0, 2)
    ],
    "edges": [
        {
            "edgeId": "e1",
            "sequenceId": 1,
            "released": False,
            "startNodeId": "n0",
            "endNodeId": "n2",
            "actions": [],
        }
    ],
}
STATE = {
    "orderId": "day",
    "orderUpdateId": 1,
    "lastNodeId": "n0",
    "lastNodeSequenceId": 0,
    "driving": False,
    "paused": False,
    "nodeStates": [{"nodeId": "n2", "sequenceId": 2, "released": False}],
    "edgeStates": [{"edgeId": "e1", "sequenceId": 1, "released": False}],
    "actionStates": [
        {"actionId": "a0", "actionStatus": "FINISHED", "resultDescription": '{"found": true}'}
    ],
    "agvPosition": {"x": 1.0, "y": 2.0, "theta": 0.5, "mapId": "map", "positionInitialized": True},
    "batteryState": {"batteryCharge": 80.0, "charging": False},
    "operatingMode": "AUTOMATIC",
    "errors": [{"errorType": "dust", "errorLevel": "WARNING", "errorDescription": "lens"}],
    "information": [{"infoType": "day_s", "infoLevel": "INFO", "infoDescription": "12.5"}],
    "safetyState": {"eStop": "NONE", "fieldViolation": False},
}
CONNECTION = {"connectionState": "ONLINE"}
