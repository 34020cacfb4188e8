"""Stored figures say what kind of machine they are from, not which one."""


def pytest_benchmark_update_machine_info(config, machine_info):  # noqa: ARG001 - a hook's names
    machine_info.pop("node", None)
