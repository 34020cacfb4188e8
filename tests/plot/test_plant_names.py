"""What people call rows and blocks of plants."""

import numpy as np

from fieldmon.plot.plant_names import PlantNames


def test_names_say_of_how_many_plants_they_are():
    assert repr(PlantNames()) == "<PlantNames: 0 plants>"
    assert repr(PlantNames(np.array(["1", "2", "2"]))) == "<PlantNames: 3 plants>"
